"""What the servos of a machine file say against the machine: names, units, ranges, park, speed."""

from collections.abc import Iterator

import numpy as np

from bridge.calibration import Calibration
from hexapod_control.stacks.kinematics import StackKinematics
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.formatting import nearest, told_apart
from manipulator.limits.wording import in_words
from manipulator.machine import Machine
from manipulator.pose import Pose

PARK_SHARE = 1e-4
"""m or rad by which a stack's park position may be off the rule that shares its motion."""


def contradictions(
    machine: Machine, calibration: Calibration, is_home_good: bool
) -> Iterator[str]:
    """Contradictions between servos and machine; where home is wrong, park can hardly be right."""
    expected, names = machine.kinematics.joint_names, list(calibration.names)
    for name in (name for name in expected if name not in names):
        near = nearest(name, [other for other in names if other not in expected])
        yield f'servos.joints: none is called {name!r}{f", but {near!r}" if near else ""}'
        if near:
            names[names.index(near)] = name
    if calibration.unit != machine.kinematics.joint_unit:
        unit = 'millimetres' if calibration.unit == 'm' else 'degrees'
        yield f'servos.joints: in {unit}, which are not what the joints of this kind are in'
        return
    yield from _slow_servos(machine, calibration)
    if {*expected} <= {*names}:
        order = [names.index(name) for name in expected]
        yield from _narrow_servos(machine, calibration, order)
        if is_home_good:
            yield from _park_problems(machine, calibration, order)


def _narrow_servos(machine: Machine, calibration: Calibration, order: list[int]) -> Iterator[str]:
    factor, unit = _file_unit(calibration)
    narrow: dict[tuple[str, str], list[str]] = {}
    for i, low, high in zip(order, *machine.joint_ranges, strict=True):
        lowest, highest = calibration.range_of(i)
        count = 1.0 / abs(float(calibration.scale[i]))
        if lowest > low + count or highest < high - count:
            ends = told_apart(np.array([lowest, highest, low, high]) * factor, fewest=4)
            reach, span = (f'[{low}, {high}] {unit}' for low, high in (ends[:2], ends[2:]))
            narrow.setdefault((reach, span), []).append(calibration.names[i])
    for (reach, span), some in narrow.items():
        reaches, whose = ('reach', 'their') if len(some) > 1 else ('reaches', 'its')
        names = ', '.join(some)
        yield f'servos.joints: {names} {reaches} {reach}, {whose} range in limits is {span}'


def _park_problems(machine: Machine, calibration: Calibration, order: list[int]) -> Iterator[str]:
    _, unit = _file_unit(calibration)
    park = calibration.park[order]
    try:
        pose = machine.kinematics.forward(park).pose
    except NoSolution as error:
        yield f'servos.park_{unit}: no pose that can be trusted: {error}'
        return
    for words in in_words(machine.constraints.violations(pose, park)):
        yield f'servos.park_{unit}: {words}'
    if isinstance(machine.kinematics, StackKinematics):
        yield from _unshared_park(machine.kinematics, pose, park, unit)


def _unshared_park(
    kinematics: StackKinematics, pose: Pose, park: Array, unit: str
) -> Iterator[str]:
    """Of a stack, whose joints at a pose are those of a rule: it would jump when it is enabled."""
    joints = kinematics.inverse_or_nan(pose, park)
    worst = int(np.argmax(np.abs(joints - park)))
    if not np.abs(joints - park)[worst] < PARK_SHARE:
        yield (
            f'servos.park_{unit}: not where the sections share the pose of the end '
            f'(docs/kinematics.md, 9): {kinematics.joint_names[worst]} would be at '
            f'{joints[worst]:.5g} {kinematics.joint_unit}'
        )


def _slow_servos(machine: Machine, calibration: Calibration) -> Iterator[str]:
    factor, unit = _file_unit(calibration)
    expected = float(np.max(machine.motion.joint.speed)) * factor
    rated = calibration.speed * factor
    if np.isfinite(expected) and expected > rated * (1 + 1e-9):
        asked, most = told_apart([expected, rated])
        yield (
            f'motion.joint_speed_{unit}_s: {asked} is more than the servos do '
            f'(servos.speed_{unit}_s: {most})'
        )


def _file_unit(calibration: Calibration) -> tuple[float, str]:
    """The unit of the file, and how many of it make one of ours."""
    return (1e3, 'mm') if calibration.unit == 'm' else (float(np.degrees(1.0)), 'deg')
