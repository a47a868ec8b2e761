"""`hexarm draw MACHINE`: the machine at a pose, from above and the sides, with its measures."""

import argparse
from pathlib import Path

from hexarm.cli.answers import (
    Answer,
    add_machine,
    add_units,
    answering,
    picture_file,
    pose_asked,
)
from hexarm.machines import load
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('draw')
    add_machine(parser)
    parser.add_argument(
        '--xyz', nargs=3, type=float, metavar=('X', 'Y', 'Z'), help='default: home'
    )
    parser.add_argument(
        '--rpy', nargs=3, type=float, metavar=('R', 'P', 'Y'), help='default: as at home'
    )
    add_units(parser)
    parser.add_argument(
        '-o', '--output', type=picture_file, metavar='PICTURE', help='default: MACHINE.png here'
    )
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Where the picture is; Unreachable for a pose that the mechanism does not reach."""
    from hexarm.pictures.machine import draw  # noqa: PLC0415 (matplotlib is an extra)

    machine = load(arguments.machine)
    name = Path(arguments.machine).stem
    pose = _pose(machine, arguments)
    with hint_at_metres(machine.kinematics, pose):
        joints = machine.kinematics.inverse(pose)
    beyond = [str(v) for v in machine.constraints.violations(pose, joints)]
    picture = draw(machine, pose, arguments.output or Path(f'{name}.png'), name)
    lines = [str(picture), *(f'beyond a limit: {words}' for words in beyond)]
    return {'picture': str(picture), 'beyond_limits': beyond}, lines


def _pose(machine: Machine, arguments: argparse.Namespace) -> Pose:
    """That of --xyz and --rpy; each as at home where it is not given."""
    home = machine.kinematics.home
    asked = argparse.Namespace(**vars(arguments))
    asked.xyz, asked.rpy = arguments.xyz or (0.0, 0.0, 0.0), arguments.rpy or (0.0, 0.0, 0.0)
    pose = pose_asked(asked)
    position = home.position if arguments.xyz is None else pose.position
    return Pose(position, home.rotation if arguments.rpy is None else pose.rotation)
