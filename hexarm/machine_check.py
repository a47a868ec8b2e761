"""Everything that is wrong with a machine file: in each section, and between them."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from bridge.calibration import Calibration
from bridge.servo_config import ServosConfig
from hexapod_control import load as hexapods
from hexapod_control.home import home_problems
from hexapod_control.load_stack import StackConfig
from hexapod_control.stack_kinematics import StackKinematics
from hexarm.machine_keys import BRIDGE, KINDS, sections_of
from hexarm.machine_spelling import corrected
from hexarm.machine_warnings import warnings_of
from hexarm.machines import frames_of, loader, with_sections
from hexarm.simulation.dynamics_config import SCHEMAS
from manipulator.arrays import Array
from manipulator.config import build, forms_of, nearest, parse_yaml
from manipulator.errors import ConfigError, ManipulatorError, NoSolution
from manipulator.formatting import shown, told_apart
from manipulator.limits.wording import in_words
from manipulator.machine import Machine, MachineFile
from manipulator.motion_limits import MotionConfig
from manipulator.pose import Pose

T = TypeVar('T')
ROOM = ('geometry', 'limits')
FEW = 2
"""So many times more keys of another kind than of its own: that kind is meant."""
INDEX = re.compile(r'\[(\d+)\]')

STAND_IN = MotionConfig(1.0, 1.0, 10.0, 1.0, 1.0, 10.0)
"""For a motion section with faults of its own, so that the others are looked at all the same."""


PARK_SHARE = 1e-4
"""m or rad by which a stack's park position may be off the rule that shares its motion."""


class Findings:
    """What was wrong with everything that was tried."""

    def __init__(self) -> None:
        self.problems: list[str] = []

    def of(self, make: Callable[[], T]) -> T | None:
        """What `make` returns; None, and its problems noted, where it cannot."""
        try:
            return make()
        except ConfigError as error:
            self.problems.extend(error.problems)
        except ManipulatorError as error:
            self.problems.append(str(error))
        return None


@dataclass(frozen=True)
class Report:
    """What is wrong with a machine file, what is doubtful, and the machine if one can be made."""

    problems: tuple[str, ...]
    warnings: tuple[str, ...] = ()
    machine: Machine | None = None


def problems_of(text: str, folder: Path = Path()) -> list[str]:
    """All problems of the text of a machine file in a folder, none for a good one."""
    try:
        return list(report_of(with_sections(parse_yaml(text), folder)).problems)
    except ConfigError as error:
        return list(error.problems)


def report_of(content: Mapping[str, Any]) -> Report:
    """Of a machine file that could be read.

    The sections first, each as far as it is there; then what one contains about another, as far
    as both are good: home, names, units, ranges, speeds and the park position.
    """
    found = Findings()
    content = dict(corrected(MachineFile, content, '', found.problems))
    kind = _kind(found, content)
    schemas = sections_of(kind) if kind else BRIDGE
    content = content | {
        name: corrected(schema, content[name], name, found.problems)
        for name, schema in schemas.items()
        if name in content
    }
    whole = found.of(lambda: build(MachineFile, content))
    unfit = _unfit(kind, content)
    if unfit:
        return Report(unfit)
    sections = {
        name: found.of(partial(build, schema, content[name], name))
        for name, schema in schemas.items()
        if isinstance(content.get(name), Mapping)
    }
    if kind == 'stack':
        _check_sections(found, sections.get('geometry'))
    machine = None
    if kind and all(sections.get(name) for name in ROOM):
        machine = found.of(lambda: _machine(kind, content, whole))
    if machine is not None and whole is not None:
        found.of(partial(frames_of, whole, machine.kinematics))
        machine = found.of(partial(machine.within, whole.task_space)) or machine
    calibration = _calibration(found, sections.get('servos'))
    if machine is not None:
        home = _home_problems(kind, machine, content)
        found.problems += home
        if calibration is not None:
            found.problems += _between(machine, calibration, is_home_good=not home)
    doubts = [] if machine is None else warnings_of(machine, calibration, content['geometry'])
    return Report(_merged(found.problems), tuple(doubts), machine)


def _kind(found: Findings, content: Mapping[str, Any]) -> str:
    """The kind that the file is of, whatever it says of it; empty where nothing tells."""
    told, likely = content.get('kind'), _kind_by_keys(content)
    if not isinstance(told, str):
        return likely
    if told not in KINDS:
        found.of(lambda: loader(told))
        return likely
    own, other = (_shared(content, kind) for kind in (told, likely or told))
    if other > FEW * max(own, 1):
        found.problems.append(f'kind: {shown(told)}, but geometry has the keys of a {likely}')
        return likely
    return told


def _unfit(kind: str, content: Mapping[str, Any]) -> tuple[str, ...]:
    """Why a file of this kind need not be looked at any further."""
    geometry, limits = (content.get(name) for name in ROOM)
    if kind not in KINDS or not isinstance(geometry, Mapping) or not isinstance(limits, Mapping):
        return ()
    try:
        KINDS[kind].screen(geometry, limits)
    except ConfigError as error:
        return error.problems
    return ()


def _kind_by_keys(content: Mapping[str, Any]) -> str:
    shared = {kind: _shared(content, kind) for kind in KINDS}
    best = max(shared.values())
    return next(kind for kind in KINDS if shared[kind] == best) if best else ''


def _shared(content: Mapping[str, Any], kind: str) -> int:
    """How many keys of the section geometry this kind has."""
    geometry = content.get('geometry')
    keys = {*geometry} if isinstance(geometry, Mapping) else set()
    return max(
        len({f.name for f in fields(form)} & keys) for form in forms_of(KINDS[kind].geometry)
    )


def _calibration(found: Findings, servos: object) -> Calibration | None:
    if not isinstance(servos, ServosConfig):
        return None
    return found.of(lambda: Calibration.from_config(servos))


def _home_problems(kind: str, machine: Machine, content: Mapping[str, Any]) -> list[str]:
    if kind not in hexapods.KINDS:
        return []
    return home_problems(machine, 'crank_tangents' in content['geometry'])


def _merged(problems: Sequence[str]) -> tuple[str, ...]:
    """Each that several entries of a list have once, with all their numbers."""
    groups: dict[str, list[str]] = {}
    for problem in dict.fromkeys(problems):
        where, colon, what = problem.partition(': ')
        groups.setdefault(INDEX.sub('[]', where, count=1) + colon + what, []).append(where)
    return tuple(
        text.replace('[]', f'[{", ".join(INDEX.findall(" ".join(places)))}]', 1)
        for text, places in groups.items()
    )


def _machine(kind: str, content: Mapping[str, Any], whole: MachineFile | None) -> Machine:
    """What the sections geometry and limits make, even if home is beyond limits."""
    geometry, limits = (content.get(name, {}) for name in ROOM)
    motion = STAND_IN if whole is None else whole.motion
    make = hexapods.platform if kind in hexapods.KINDS else loader(kind)
    return make(MachineFile(kind, geometry, limits, motion, driver='topic'))


def _check_sections(found: Findings, geometry: object) -> None:
    """What the sections of a stack say of their masses and drives."""
    for i, section in enumerate(geometry.sections if isinstance(geometry, StackConfig) else ()):
        if section.dynamics is not None and section.kind in SCHEMAS:
            where = f'geometry.sections[{i}].dynamics'
            found.of(partial(build, SCHEMAS[section.kind], section.dynamics, where))


def _between(machine: Machine, calibration: Calibration, is_home_good: bool) -> Iterator[str]:
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
