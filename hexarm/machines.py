"""Finding and loading machine files: by path, then beside the source, then in share/."""

import os
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bridge.calibration import Calibration
from bridge.servo_config import BoardConfig, ServosConfig
from manipulator.arrays import frozen
from manipulator.config import MAX_CHARACTERS, build, parse_yaml
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import (
    did_you_mean,
    nearest,
    not_one_of,
    reason,
    shortened,
    shown,
)
from manipulator.frames import Frames
from manipulator.kinematics import Kinematics
from manipulator.machine import Machine, MachineFile
from manipulator.pose import Pose
from manipulator.static_deflection import StaticDeflection
from manipulator.unit_hints import check_pivot, check_tool


def _hexapod(machine_file: MachineFile) -> Machine:
    from hexapod_control.load import hexapod  # noqa: PLC0415 (an arm's node loads no hexapod)

    return hexapod(machine_file)


def _arm(machine_file: MachineFile) -> Machine:
    from arm_control.load import arm  # noqa: PLC0415

    return arm(machine_file)


def _stack(machine_file: MachineFile) -> Machine:
    from hexapod_control.stacks.load import stack  # noqa: PLC0415

    return stack(machine_file)


KINDS: dict[str, Callable[[MachineFile], Machine]] = {
    'rotary_hexapod': _hexapod,
    'linear_hexapod': _hexapod,
    'rail_hexapod': _hexapod,
    'serial_arm': _arm,
    'stack': _stack,
}


NEEDED = ('kind', 'geometry', 'limits', 'motion')
"""Keys of which every machine file has some."""
OTHER_FILES = {
    'deadman': 'a gamepad (docs/joystick.md)',
    'sticks': 'a gamepad (docs/joystick.md)',
    'poses': 'saved poses (docs/teach.md)',
    'sequences': 'saved poses (docs/teach.md)',
}
"""By one of its keys, what another file of this project is for."""
OF_A_SECTION = ('kind', 'geometry', 'limits', 'dynamics')
"""What a stack's section takes of the machine file that it names."""


def folders() -> list[Path]:
    """Where shipped files may be: config/ of a source tree, share/hexarm/config of a prefix."""
    here = Path(__file__).resolve()
    candidates = [here.parent.parent / 'config']
    candidates += [parent / 'share' / 'hexarm' / 'config' for parent in here.parents]
    return [folder for folder in candidates if folder.is_dir()]


def shipped() -> dict[str, Path]:
    """The machine files that come with the package, by name."""
    files = (f for folder in reversed(folders()) for f in sorted(folder.glob('*.yaml')))
    return {f.stem: f for f in files if re.search(r'^kind:', f.read_text(), re.MULTILINE)}


def find(name_or_path: str) -> Path:
    """The file of a shipped machine's name, or of a path; ConfigError names what there is."""
    path = Path(name_or_path).expanduser()
    if path.suffix in ('.yaml', '.yml') or '/' in name_or_path:
        if os.path.isfile(path):
            return path
        fault = 'is not a file' if os.path.exists(path) else 'does not exist'
        raise ConfigError([f'machine file {shortened(name_or_path, 200)} {fault}'])
    known = shipped()
    if name_or_path not in known and os.path.isfile(path):
        return path
    if name_or_path in known:
        return known[name_or_path]
    hint = did_you_mean(nearest(name_or_path, known))
    raise ConfigError(
        [f'no machine is called {shown(name_or_path)}{hint} (shipped: {", ".join(sorted(known))})']
    )


def saved_poses_file(name_or_path: str) -> Path:
    """Where a machine's saved poses are: beside its file; of a shipped one in the user's data."""
    path = find(name_or_path)
    folder = path.parent
    if path in shipped().values():
        folder = Path(os.environ.get('XDG_DATA_HOME') or '~/.local/share').expanduser() / 'hexarm'
    return folder / f'{path.stem}.poses.yaml'


def read(name_or_path: str) -> MachineFile:
    """The sections of a machine file; ConfigError lists everything wrong at the top level."""
    path = find(name_or_path)
    return build(MachineFile, content_of(path), source=str(path))


def content_of(path: Path) -> dict[str, Any]:
    """What a machine file holds, see `with_sections`."""
    content = parse_yaml(text_of(path), str(path))
    try:
        check_is_machine(content)
        return with_sections(content, path.parent)
    except ConfigError as error:
        raise ConfigError(error.problems, str(path)) from error


def check_is_machine(content: Mapping[str, Any]) -> None:
    """Raises ConfigError, with one problem, for a file that is for something else."""
    if any(name in content for name in NEEDED):
        return
    other = next((words for key, words in OTHER_FILES.items() if key in content), '')
    are = f'its keys are those of {other}' if other else f'{", ".join(NEEDED)} are missing'
    raise ConfigError([f'this is no machine file: {are}'])


def with_sections(content: dict[str, Any], folder: Path) -> dict[str, Any]:
    """A machine file's content; a stack's sections that name a machine hold what its file does.

    Such a name is that of a shipped machine, or a path from the folder of the stack's file.
    """
    geometry = content.get('geometry')
    if content.get('kind') != 'stack' or not isinstance(geometry, dict):
        return content
    sections = geometry.get('sections')
    if not isinstance(sections, list):
        return content
    from hexapod_control.stacks.load import check_count  # noqa: PLC0415

    problems, there = [], []
    try:
        check_count(len(sections))
    except ConfigError as error:
        raise ConfigError([f'geometry.{p}' for p in error.problems]) from error
    for i, section in enumerate(sections):
        try:
            there.append(_section(section, folder))
        except ConfigError as error:
            problems.append(f'geometry.sections[{i}].machine: {error}')
    if problems:
        raise ConfigError(problems)
    return {**content, 'geometry': {**geometry, 'sections': there}}


def _section(section: object, folder: Path) -> object:
    """A section of a stack, with what the machine file that it names says of the platform."""
    if not isinstance(section, dict) or 'machine' not in section:
        return section
    name = section['machine']
    if not isinstance(name, str):
        raise ConfigError([f'{shown(name)} is neither a name nor a path'])
    own = sorted(set(section) & set(OF_A_SECTION))
    if own:
        problem = f'{shown(name)} gives {" and ".join(own)}, and so does this section'
        raise ConfigError([problem])
    is_path = '/' in name or name.endswith(('.yaml', '.yml'))
    file = find(str(folder / name) if is_path else name)
    content = parse_yaml(text_of(file), str(file))
    return {**section, **{key: content[key] for key in OF_A_SECTION if key in content}}


def family(name_or_path: str) -> str:
    """'arm' or 'hexapod': the namespace where such a machine's graph lives by default."""
    return 'arm' if loader(read(name_or_path).kind) is _arm else 'hexapod'


def board_config(name_or_path: str) -> BoardConfig:
    """What the bridge and the board need of a machine file; ConfigError with all problems."""
    return BoardConfig.from_machine(read(name_or_path), str(find(name_or_path)))


def described(name_or_path: str) -> str:
    """Which file a name or a path means, and what it is of, in one line."""
    path, machine_file = find(name_or_path).resolve(), read(name_or_path)
    kind = machine_file.kind.replace('_', ' ')
    words = f'{kind}; {shortened(machine_file.description)}' if machine_file.description else kind
    return f'machine {path.stem}: {path} ({words})'


def text_of(path: Path) -> str:
    """What a file holds; ConfigError where it cannot be read as text, or is huge."""
    try:
        size = path.stat().st_size
        if size > 4 * MAX_CHARACTERS:
            problem = f'{size} bytes, a machine file has at most {MAX_CHARACTERS} characters'
            raise ConfigError([problem], str(path))
        return path.read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError([f'cannot be read: {reason(error)}'], str(path)) from error


def loader(kind: str) -> Callable[[MachineFile], Machine]:
    """What makes machines of this kind; ConfigError names the kinds that there are."""
    if kind in KINDS:
        return KINDS[kind]
    raise ConfigError([f'kind: {not_one_of(kind, KINDS)}'])


def load(name_or_path: str) -> Machine:
    """Kinematics, constraints and motion limits of a machine; ConfigError with all problems."""
    machine_file = read(name_or_path)
    try:
        machine = loader(machine_file.kind)(machine_file)
        machine = machine.within(machine_file.task_space)
        frames = frames_of(machine_file, machine.kinematics)
        machine = machine.among(machine_file.surroundings, machine_file.bodies, frames.tools)
        machine = replace(machine, deflection=_deflection(machine_file, machine.kinematics))
        frames = replace(frames, is_load_fixed=machine.deflection is not None)
        machine = replace(machine, frames=frames)
    except ConfigError as error:
        raise ConfigError(error.problems, str(find(name_or_path))) from error
    return _with_servos(machine, machine_file)


def frames_of(machine_file: MachineFile, kinematics: Kinematics) -> Frames:
    """The frames of a file; ConfigError for pivots and tools that do not fit the machine."""
    frames = Frames.from_config(machine_file.frames, machine_file.tools)
    problems = []
    if not frames.tools:
        check = partial(check_pivot, kinematics, frames.T_platform_pivot)
        problems += _doubt('frames.pivot_xyz_mm', check)
    for i, tool in enumerate(frames.tools):
        problems += _doubt(f'tools[{i}].xyz_mm', partial(check_tool, kinematics, tool))
        centre = Pose.from_xyz_rpy(1e-3 * np.array(tool.load[1:]), (0.0, 0.0, 0.0))
        name = f'centre of tool {tool.name!r}'
        if machine_file.tools[i].centre_mm is not None:
            problems += _doubt(
                f'tools[{i}].centre_mm', partial(check_pivot, kinematics, centre, name)
            )
    if problems:
        raise ConfigError(problems)
    return frames


def _doubt(place: str, check: Callable[[], None]) -> list[str]:
    """What a check raises, as problems of the file."""
    try:
        check()
    except InvalidInput as error:
        return [f'{place}: {error}']
    return []


def _with_servos(machine: Machine, machine_file: MachineFile) -> Machine:
    """With the joints at park, and their resolution; without where the servos cannot be used."""
    try:
        calibration = Calibration.from_config(build(ServosConfig, machine_file.servos, 'servos'))
        order = [calibration.names.index(name) for name in machine.kinematics.joint_names]
    except (ConfigError, ValueError):
        return machine
    resolution = frozen(1.0 / np.abs(calibration.scale[order]))
    return replace(machine, park=frozen(calibration.park[order]), resolution=resolution)


def _deflection(machine_file: MachineFile, kinematics: Kinematics) -> StaticDeflection | None:
    """The static deflection that the machine's nodes compensate, where its file sets that."""
    if (machine_file.dynamics or {}).get('compensation') is not True:
        return None
    from hexarm.simulation.compensation import deflection_of  # noqa: PLC0415 (most machines need no masses)

    return deflection_of(machine_file, kinematics)
