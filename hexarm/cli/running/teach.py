"""`hexarm save|poses|delete|replay NAMESPACE`: poses that are taught, and taken again."""

import argparse
from typing import TYPE_CHECKING

from hexarm.cli.answers import Answer, for_programs, units_of
from hexarm.cli.progress import progress
from hexarm.cli.running.drive import add_driving, pose
from manipulator.errors import InvalidInput

if TYPE_CHECKING:
    from hexarm.robot import Robot


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommands."""
    parser = add_driving(commands, 'save', save, moves=False)
    parser.add_argument('name', nargs='?', default='', help='default: pose_1, pose_2, …')
    add_driving(commands, 'poses', poses, moves=False)
    parser = add_driving(commands, 'delete', delete, names_follow=True, moves=False)
    parser.add_argument('name', metavar='NAME', help='of a saved pose')
    parser = add_driving(commands, 'replay', replay, names_follow=True)
    parser.add_argument('names', nargs='+', metavar='NAME', help='of saved poses and sequences')
    parser.add_argument(
        '--speed', type=float, metavar='V', help="m/s (or mm/s), at most; replaces the sequence's"
    )
    parser.add_argument('--pause', type=float, metavar='S', help='s, after every pose')
    parser.add_argument('--repeat', type=int, default=1, metavar='N', help='times; default 1')


def save(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Saves the measured pose."""
    name = robot.save_pose(arguments.name)
    saved = robot.saved_poses.of(name)
    answer = {'name': name, 'pose': for_programs(saved.pose)}
    return answer, [f'saved {name}:', *units_of(arguments).pose(saved.pose)]


def poses(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Lists the saved poses and sequences."""
    units, saved = units_of(arguments), robot.saved_poses
    lines = []
    for name, one in saved.poses.items():
        lines += [f'{name}:', *(f'  {line}' for line in units.pose(one.pose))]
    for name, steps in saved.sequences.items():
        lines.append(f'{name}: sequence of {", ".join(step.pose for step in steps)}')
    answer = {
        'poses': {name: for_programs(one.pose) for name, one in saved.poses.items()},
        'sequences': {
            name: [
                {'pose': step.pose, 'speed': step.speed, 'pause': step.pause_s} for step in steps
            ]
            for name, steps in saved.sequences.items()
        },
    }
    nothing = f'no pose is saved yet: hexarm save {robot.namespace.strip("/")} NAME'
    return answer, lines or [nothing]


def delete(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Deletes a saved pose."""
    robot.delete_pose(arguments.name)
    return {'name': arguments.name}, [f'deleted {arguments.name}']


def replay(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Goes through saved poses and sequences; Ctrl-C brakes."""
    if not 1 <= arguments.repeat <= 1_000_000:
        raise InvalidInput(f'--repeat {arguments.repeat}: needs 1 to 1000000')
    speed = arguments.speed and arguments.speed / units_of(arguments).per_metre
    with progress() as report:
        robot.replay(
            *arguments.names,
            speed=speed,
            pause=arguments.pause,
            repeat=arguments.repeat,
            progress=lambda share: report('replay', share),
        )
    return pose(robot, arguments)
