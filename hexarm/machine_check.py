"""Everything that is wrong with a machine file: in each section, and between them."""

import difflib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Any, TypeVar

import numpy as np

from bridge.calibration import Calibration
from bridge.servo_config import ServosConfig
from hexapod_control import load as hexapods
from hexapod_control.home import home_problems
from hexarm.machine_keys import BRIDGE, KINDS, sections_of
from hexarm.machine_warnings import warnings_of
from hexarm.machines import frames_of, loader
from manipulator.arrays import Array
from manipulator.config import build, forms_of, parse_yaml
from manipulator.errors import ConfigError, ManipulatorError, NoSolution
from manipulator.formatting import shown
from manipulator.limits.wording import in_words
from manipulator.machine import Machine, MachineFile
from manipulator.motion_limits import MotionConfig

T = TypeVar('T')
ROOM = ('geometry', 'limits')
FEW = 2
"""So many times more keys of another kind than of its own: that kind is meant."""
INDEX = re.compile(r'\[(\d+)\]')

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
    """What is wrong with a machine file, what is doubtful, and the machine if one can be made."""

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

    The sections first, each as far as it is there; then what one contains about another, as far
    as both are good: home, names, units, ranges, speeds and the park position.
    """
    found = Findings()
    whole = found.of(lambda: build(MachineFile, content))
    kind, other = str(content.get('kind')), _kind_by_keys(content)
    if other:
        found.problems.append(f'kind: {shown(kind)}, but geometry has the keys of a {other}')
    schemas = sections_of(kind) if kind in KINDS and not other else BRIDGE
    unfit = _unfit(kind, content)
    if unfit:
        return Report(unfit)
    sections = {
        name: found.of(partial(build, schema, content[name], name))
        for name, schema in schemas.items()
        if isinstance(content.get(name), Mapping)
    }
    is_whole = all(sections.get(name) for name in ROOM if name in schemas)
    machine = None
    if isinstance(content.get('kind'), str) and is_whole and not other:
        machine = found.of(lambda: _machine(kind, content, whole))
    if machine is not None and whole is not None:
        found.of(partial(frames_of, whole, machine.kinematics))
        machine = found.of(partial(machine.within, whole.task_space)) or machine
    calibration = _calibration(found, sections.get('servos'))
    if machine is not None:
        home = _home_problems(machine, content)
        found.problems += home
        if calibration is not None:
            found.problems += _between(machine, calibration, is_home_good=not home)
    doubts = () if machine is None else warnings_of(machine, calibration)
    return Report(_merged(found.problems), tuple(doubts), machine)


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
    """The kind whose keys the section geometry has, where it has none of the kind that is told."""
    geometry, told = content.get('geometry'), content.get('kind')
    if not isinstance(geometry, Mapping) or not isinstance(told, str) or told not in KINDS:
        return ''
    shared = {
        kind: max(len({f.name for f in fields(form)} & {*geometry}) for form in forms_of(room))
        for kind, room in ((name, KINDS[name].geometry) for name in KINDS)
    }
    likely = max(shared, key=shared.__getitem__)
    return likely if shared[likely] > FEW * max(shared[told], 1) else ''


def _calibration(found: Findings, servos: object) -> Calibration | None:
    if not isinstance(servos, ServosConfig):
        return None
    return found.of(lambda: Calibration.from_config(servos))


def _home_problems(machine: Machine, content: Mapping[str, Any]) -> list[str]:
    if content['kind'] not in hexapods.KINDS:
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


def _between(machine: Machine, calibration: Calibration, is_home_good: bool) -> Iterator[str]:
    """Contradictions between servos and machine; where home is wrong, park can hardly be right."""
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
        if is_home_good:
            yield from _park_problems(machine, calibration, order)
        yield from _slow_servos(machine, calibration)


def _narrow_servos(machine: Machine, calibration: Calibration, order: list[int]) -> Iterator[str]:
    factor, unit = _file_unit(calibration)
    narrow: dict[tuple[str, str], list[str]] = {}
    for i, low, high in zip(order, *machine.joint_ranges, strict=True):
        lowest, highest = calibration.range_of(i)
        count = 1.0 / abs(float(calibration.scale[i]))
        if lowest > low + count or highest < high - count:
            ends = np.array([lowest, highest, low, high]) * factor
            narrow.setdefault(_told_apart(ends, unit), []).append(calibration.names[i])
    for (reach, span), some in narrow.items():
        reaches, whose = ('reach', 'their') if len(some) > 1 else ('reaches', 'its')
        names = ', '.join(some)
        yield f'servos.joints: {names} {reaches} {reach}, {whose} range in limits is {span}'


def _told_apart(ends: Array, unit: str) -> tuple[str, str]:
    """Two intervals, with as many digits as tell them apart."""
    for digits in range(4, 13):
        reach, span = (
            f'[{low:.{digits}g}, {high:.{digits}g}] {unit}' for low, high in (ends[:2], ends[2:])
        )
        if reach != span:
            break
    return reach, span


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
