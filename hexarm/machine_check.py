"""Everything that is wrong with a machine file: in each section, and between them."""

import re
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from bridge.calibration import Calibration
from bridge.servo_config import ServosConfig
from hexapod_control import load as hexapods
from hexapod_control.home import home_problems
from hexapod_control.stacks.load import StackConfig
from hexarm.link_meshes import link_meshes
from hexarm.machine_keys import BRIDGE, KINDS, sections_of
from hexarm.machine_warnings import radians_for_degrees, warnings_of
from hexarm.machines import check_is_machine, frames_of, loader, with_sections
from hexarm.servo_check import contradictions
from hexarm.simulation.dynamics_config import SCHEMAS
from manipulator.config import build, fitting_form, forms_of, parse_yaml, unknown_key
from manipulator.errors import ConfigError, ManipulatorError
from manipulator.formatting import shown
from manipulator.frames import Frames
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


def problems_of(text: str, folder: Path = Path()) -> list[str]:
    """All problems of the text of a machine file in a folder, none for a good one."""
    try:
        return list(report_of(parse_yaml(text), folder).problems)
    except ConfigError as error:
        return list(error.problems)


def report_of(content: Mapping[str, Any], folder: Path | None = None) -> Report:
    """Of a machine file that could be read; folder: where it is, unless `with_sections` was there.

    The sections first, each as far as it is there; then what one contains about another, as far
    as both are good: home, names, units, ranges, speeds and the park position.
    """
    found = Findings()
    corrected_keys = _corrected(MachineFile, content, '', found.problems)
    try:
        check_is_machine(corrected_keys)
    except ConfigError as error:
        return Report(error.problems)
    kind, content, whole = _as_meant(found, dict(corrected_keys), folder)
    schemas = sections_of(kind) if kind else BRIDGE
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
        frames = found.of(partial(frames_of, whole, machine.kinematics)) or Frames()
        machine = found.of(partial(machine.within, whole.task_space)) or machine
        around = whole.surroundings, whole.bodies, frames.tools
        machine = found.of(partial(machine.among, *around)) or machine
    calibration = _calibration(found, sections.get('servos'))
    if machine is not None:
        home = _home_problems(kind, machine, content)
        found.problems += home
        if calibration is not None:
            found.problems += contradictions(machine, calibration, is_home_good=not home)
    doubts = [*radians_for_degrees(content).values()]
    doubts += [] if machine is None else warnings_of(machine, calibration, content['geometry'])
    if machine is not None and folder is not None:
        doubts += link_meshes(content['geometry'], folder)[1]
    return Report(_merged(found.problems), tuple(doubts), machine)


def _as_meant(
    found: Findings, content: dict[str, Any], folder: Path | None
) -> tuple[str, dict[str, Any], MachineFile | None]:
    """The kind, the content without misspelt keys, and the sections where they are all right.

    Of content whose own keys are right.
    """
    kind = _kind(found, content)
    content = content | {
        name: _corrected(schema, content[name], name, found.problems)
        for name, schema in (sections_of(kind) if kind else BRIDGE).items()
        if name in content
    }
    whole = found.of(lambda: build(MachineFile, content))
    if folder is not None:
        full = found.of(partial(with_sections, content | {'kind': kind}, folder))
        content = content | {'geometry': None} if full is None else full
    return kind, content, whole


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
        text.replace('[]', f'[{", ".join(m[1] for m in map(INDEX.search, places) if m)}]', 1)
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


def _corrected(schema: Any, content: object, where: str, problems: list[str]) -> Any:
    """The content with each misspelt key under its right name; `problems` gets a line for each.

    A key whose right name is there as well, or that is like none, stays as it is. Of the check
    alone: what drives a machine takes no key for another.
    """
    if isinstance(content, list):
        kinds = [form for form in forms_of(schema) if typing.get_origin(form) is tuple]
        inner = typing.get_args(kinds[0])[0] if kinds else None
        return [_corrected(inner, v, f'{where}[{i}]', problems) for i, v in enumerate(content)]
    forms = [form for form in forms_of(schema) if is_dataclass(form)]
    form = fitting_form(forms, content) if forms and isinstance(content, Mapping) else None
    if form is None or not isinstance(content, Mapping):
        return content
    hints, known = typing.get_type_hints(form), [f.name for f in fields(form)]
    result: dict[Any, Any] = {}
    for name, value in content.items():
        right, problem = name, ''
        if name not in known:
            near, problem = unknown_key(where, name, known)
            right = near if near and near not in content and near not in result else name
        if right != name:
            problems.append(problem)
        place = f'{where}.{right}' if where else str(right)
        result[right] = _corrected(hints.get(right), value, place, problems)
    return result
