"""`hexarm import FILE.urdf`: an arm's URDF as a machine file."""

import argparse
import re
from dataclasses import replace
from pathlib import Path

from arm_control.closed_forms import closed_form
from arm_control.urdf_chain import arm_of
from arm_control.urdf_file import MAX_CHARACTERS, read_urdf, with_right_angles
from hexarm.arm_import import ImportOptions, machine_text
from hexarm.cli.answers import Answer, answering, with_negatives
from hexarm.mesh_import import ImportedMeshes, Packages, imported_meshes, packages_of
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import counted, reason

HINT = (
    'its right angles are rounded (1.5708): with --right-angles its inverse kinematics has a '
    'closed form, which takes microseconds'
)


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('import')
    parser.add_argument('file', type=Path, metavar='FILE', help='plain URDF, as xacro writes it')
    parser.add_argument('--base', metavar='LINK', help='default: the root')
    parser.add_argument(
        '--tip', metavar='LINK', help='default: the last link that six axes move, or tool0'
    )
    parser.add_argument(
        '--right-angles', action='store_true', help='right angles that the file rounds, as 1.5708'
    )
    parser.add_argument(
        '--prefix', default='', metavar='TEXT', help='before the name of each joint, as in left_'
    )
    parser.add_argument(
        '--home', nargs=6, type=float, metavar='DEG', help='the joints at home; default: chosen'
    )
    parser.add_argument(
        '--acceleration', type=float, metavar='DEG_S2', help='of each joint; default: assumed'
    )
    parser.add_argument(
        '--package', action='append', default=[], metavar='NAME=DIR', help='of package://NAME/…'
    )
    parser.add_argument(
        '--output', type=Path, metavar='FILE', help='default: NAME.yaml, beside nothing else'
    )
    parser.add_argument('--json', action='store_true', help='answer for programs')
    with_negatives(parser)
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Where the machine file is, and what it assumes; an existing file is not written over."""
    source: Path = arguments.file
    packages = Packages(packages_of(arguments.package), source)
    try:
        robot = read_urdf(urdf_text(source))
        robot = with_right_angles(robot) if arguments.right_angles else robot
        arm = arm_of(robot, arguments.base, arguments.tip)
        named = (replace(joint, name=arguments.prefix + joint.name) for joint in arm.joints)
        arm = replace(arm, joints=tuple(named))
        exact = arm_of(with_right_angles(robot), arm.base, arm.tip)
        options = ImportOptions(arguments.home, arguments.acceleration)
        stem = re.sub(r'\W+', '_', robot.name or source.stem).strip('_') or 'arm'
        output: Path = arguments.output or Path(f'{stem}.yaml')
        folder = output.with_name(f'{output.stem}_meshes')
        meshes = imported_meshes(arm.visuals, packages.file)
        names = meshes.names(folder.name)
        imported = machine_text(
            arm, robot.name or source.stem, source.name, options, names, meshes.faults
        )
    except ConfigError as error:
        raise ConfigError(error.problems, str(source)) from error
    _write(output, imported.text, meshes if any(names) else None, folder)
    is_rounded = closed_form(arm.chain) is None and closed_form(exact.chain) is not None
    count = sum(map(bool, names))
    lines = [
        f'{output}: {arm.base} to {arm.tip}, {", ".join(joint.name for joint in arm.joints)}',
        f'{counted(len(imported.assumed), "line")} with assumed values: look for "assumed"',
        *([f'{folder}: meshes of {counted(count, "link")}'] if count else []),
        *meshes.faults,
        *([HINT] if is_rounded else []),
        f'next: hexarm check {output}; hexarm up {output} --panel',
    ]
    joints = [joint.name for joint in arm.joints]
    answer = {'output': str(output), 'base': arm.base, 'tip': arm.tip, 'joints': joints}
    answer |= {'meshes': names, 'not_imported': list(meshes.faults)}
    return answer | {'assumed': list(imported.assumed)}, lines


def _write(output: Path, text: str, meshes: ImportedMeshes | None, folder: Path) -> None:
    """InvalidInput where it cannot be written, or is there; the meshes first."""
    if output.exists():
        raise InvalidInput(f'{output} exists: another name with --output')
    if meshes is not None:
        meshes.write(folder)
    try:
        with output.open('x', encoding='utf-8') as file:
            file.write(text)
    except FileExistsError:
        raise InvalidInput(f'{output} exists: another name with --output') from None
    except OSError as error:
        raise InvalidInput(f'cannot write {output}: {reason(error)}') from error


def urdf_text(path: Path) -> str:
    """ConfigError for what cannot be read as text, or is huge."""
    try:
        with path.open(encoding='utf-8') as file:
            return file.read(MAX_CHARACTERS + 1)
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError([f'cannot be read: {reason(error)}']) from error
