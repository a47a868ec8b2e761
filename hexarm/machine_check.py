"""Everything that is wrong with a machine file: in each section, and between them."""

import difflib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

import numpy as np

from bridge.calibration import Calibration
from bridge.servo_config import ServosConfig
from hexarm.machine_keys import BRIDGE, KINDS, sections_of
from hexarm.machine_warnings import warnings_of
from hexarm.machines import frames_of, loader
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError, ManipulatorError, NoSolution
from manipulator.limits.machine_limits import JointRange
from manipulator.machine import Machine, MachineFile
from manipulator.motion_limits import MotionConfig

T = TypeVar('T')
ROOM = ('geometry', 'limits')

STAND_IN = MotionConfig(1.0, 1.0, 10.0, 1.0, 1.0, 10.0)
"""For a motion section with faults of its own, so that the others are looked at all the same."""


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
    """What is wrong with a machine file, what is doubtful, and the machine where it can be made.

    Only a file without problems has warnings.
    """

    problems: tuple[str, ...]
    warnings: tuple[str, ...] = ()
    machine: Machine | None = None


def problems_of(text: str) -> list[str]:
    """All problems of a machine file's text, none for a good one."""
    try:
        return list(report_of(parse_yaml(text)).problems)
    except ConfigError as error:
        return list(error.problems)


def report_of(content: Mapping[str, Any]) -> Report:
    """Of a machine file that could be read.

    The sections first, each as far as it is there; then, between those that are good, what one
    contains about another: names, units, ranges, speeds and the park position.
    """
    found = Findings()
    whole = found.of(lambda: build(MachineFile, content))
    kind = str(content.get('kind'))
    schemas = sections_of(kind) if kind in KINDS else BRIDGE
    sections = {
        name: found.of(partial(build, schema, content[name], name))
        for name, schema in schemas.items()
        if isinstance(content.get(name), Mapping)
    }
    machine = None
    if isinstance(content.get('kind'), str) and all(
        sections.get(name) for name in ROOM if name in schemas
    ):
        machine = found.of(lambda: _machine(kind, content, whole))
        if machine is not None and whole is not None:
            found.of(partial(frames_of, whole, machine.kinematics))
    servos, calibration = sections.get('servos'), None
    if isinstance(servos, ServosConfig):
        calibration = found.of(lambda: Calibration.from_config(servos))
        if machine is not None and calibration is not None:
            found.problems.extend(_between(machine, calibration))
    problems, doubts = tuple(found.problems), list[str]()
    if machine is not None and not problems:
        doubts = warnings_of(machine, calibration, content['geometry'])
    return Report(problems, tuple(doubts), machine)


def _machine(kind: str, content: Mapping[str, Any], whole: MachineFile | None) -> Machine:
    """What the sections geometry and limits make."""
    geometry, limits = (content.get(name, {}) for name in ROOM)
    motion = STAND_IN if whole is None else whole.motion
    return loader(kind)(MachineFile(kind, geometry, limits, motion, servos={}, link={}))


def _between(machine: Machine, calibration: Calibration) -> Iterator[str]:
    """Contradictions between servos and machine."""
    expected, names = machine.kinematics.joint_names, calibration.names
    missing = [name for name in expected if name not in names]
    for name in missing:
        near = difflib.get_close_matches(name, set(names) - set(expected), n=1)
        yield f'servos.joints: none is called {name!r}{f", but {near[0]!r}" if near else ""}'
    if calibration.unit != machine.kinematics.joint_unit:
        unit = 'millimetres' if calibration.unit == 'm' else 'degrees'
        yield f'servos.joints: in {unit}, which are not what the joints of this kind are in'
    elif not missing:
        order = [names.index(name) for name in expected]
        yield from _narrow_servos(machine, calibration, order)
        yield from _park_problems(machine, calibration, order)
        yield from _slow_servos(machine, calibration)


def _narrow_servos(machine: Machine, calibration: Calibration, order: list[int]) -> Iterator[str]:
    factor, unit = _file_unit(calibration)
    for limit in machine.constraints.limits:
        if not isinstance(limit, JointRange):
            continue
        for i, low, high in zip(order, limit.low, limit.high, strict=True):
            lowest, highest = calibration.range_of(i)
            if lowest > low + 1e-6 or highest < high - 1e-6:
                reach = f'[{lowest * factor:.4g}, {highest * factor:.4g}] {unit}'
                span = f'[{low * factor:.4g}, {high * factor:.4g}] {unit}'
                name = calibration.names[i]
                yield f'servos.joints[{i}]: {name} reaches {reach}, its range in limits is {span}'


def _park_problems(machine: Machine, calibration: Calibration, order: list[int]) -> Iterator[str]:
    _, unit = _file_unit(calibration)
    park = calibration.park[order]
    try:
        pose = machine.kinematics.forward(park).pose
    except NoSolution as error:
        yield f'servos.park_{unit}: no pose that can be trusted: {error}'
        return
    for violation in machine.constraints.violations(pose, park):
        yield f'servos.park_{unit}: {violation}'


def _slow_servos(machine: Machine, calibration: Calibration) -> Iterator[str]:
    factor, unit = _file_unit(calibration)
    expected = float(np.max(machine.motion.joint.speed)) * factor
    rated = calibration.speed * factor
    if np.isfinite(expected) and expected > rated * (1 + 1e-9):
        yield (
            f'motion.joint_speed_{unit}_s: {expected:g} is more than the servos do '
            f'(servos.speed_{unit}_s: {rated:g})'
        )


def _file_unit(calibration: Calibration) -> tuple[float, str]:
    """The unit of the file, and how many of it make one of ours."""
    return (1e3, 'mm') if calibration.unit == 'm' else (float(np.degrees(1.0)), 'deg')
