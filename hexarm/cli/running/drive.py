"""`hexarm go|home|park|pose|joints NAMESPACE`: a machine that runs, moved and measured."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from hexarm.cli.answers import (
    Answer,
    Units,
    add_units,
    answering,
    for_programs,
    units_of,
    with_negatives,
)
from hexarm.cli.running.machine_calls import remedy
from hexarm.cli.statuses import STATUSES
from hexarm.namespaces import namespace_of
from hexarm.robot_values import checked, moved_to
from manipulator.errors import ConfigError, InvalidInput, Refused, TimedOut, Unreachable
from manipulator.formatting import shown
from manipulator.pose import Pose
from manipulator.states import MachineState

if TYPE_CHECKING:
    from hexarm.robot import Robot

Act = Callable[['Robot', argparse.Namespace], Answer]


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommands."""
    parser = add_driving(commands, 'go', go, epilog=STATUSES)
    with_negatives(parser)
    parser.add_argument('name', nargs='?', metavar='NAME', help='of a saved pose')
    parser.add_argument(
        '--xyz', nargs=3, type=float, metavar=('X', 'Y', 'Z'),
        help='m (or mm); without it the position stays',
    )  # fmt: skip
    parser.add_argument(
        '--rpy', nargs=3, type=float, metavar=('R', 'P', 'Y'),
        help='roll, pitch, yaw about x, y, z in rad (or °); without it the orientation stays',
    )  # fmt: skip
    parser.add_argument(
        '--speed', type=float, metavar='V', help='m/s (or mm/s), at most; along a line'
    )
    for name, act in (('home', home), ('park', park), ('pose', pose)):
        add_driving(commands, name, act)
    parser = add_driving(commands, 'joints', joints, epilog=STATUSES)
    parser.add_argument(
        '--set', nargs='+', metavar='NAME=Q', dest='named',
        help='moves these joints first (rad or m; with --units mm: ° or mm)',
    )  # fmt: skip


def add_driving(
    commands: 'argparse._SubParsersAction[argparse.ArgumentParser]',
    name: str,
    act: Act,
    epilog: str | None = None,
    names_follow: bool = False,
    moves: bool = True,
) -> argparse.ArgumentParser:
    """Declares a subcommand of one running machine, whose answer is that of `act`.

    names_follow: of poses, among which a namespace that is left out could not be recognized.
    moves: the machine, so that a refusal ends with what lets it move.
    """
    parser = commands.add_parser(name, epilog=epilog)
    if names_follow:
        parser.add_argument('namespace', type=namespace_of, metavar='NAMESPACE')
    else:
        parser.add_argument(
            'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
        )
    parser.add_argument('--json', action='store_true', help='answer for programs')
    add_units(parser)
    parser.set_defaults(run=running(act, moves))
    return parser


def running(act: Act, moves: bool = True) -> Callable[[argparse.Namespace], int]:
    """A subcommand's `run`, with the machine of its namespace; Ctrl-C brakes it.

    If it moves, a refusal ends with the command that comes first: `hexarm enable`, `hexarm clear`.
    """

    def answer(arguments: argparse.Namespace) -> Answer:
        from hexarm.robot import Robot  # noqa: PLC0415 (needs ROS)

        with Robot(arguments.namespace) as robot:
            try:
                return act(robot, arguments)
            except Refused as error:
                first = first_step(robot.state, arguments.namespace) if moves else ''
                raise Refused(f'{error}{first}') from error

    return answering(answer)


def first_step(state: str, namespace: str) -> str:
    """What lets a machine in this state move, where a command does."""
    if state == MachineState.DISARMED:
        return f'. First: hexarm enable {namespace}'
    return remedy(state, namespace)


def go(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Moves to a pose and measures it; Unreachable where the machine cannot take it."""
    goal = goal_asked(robot, arguments)
    per_metre = units_of(arguments).per_metre
    try:
        robot.move_to(goal, speed=arguments.speed and arguments.speed / per_metre)
    except Refused as error:
        if is_out_of_reach(robot, goal):
            raise Unreachable(str(error)) from error
        raise
    return pose(robot, arguments)


def goal_asked(robot: 'Robot', arguments: argparse.Namespace) -> Pose | str:
    """The name of a saved pose, or the target with another position, orientation or both."""
    has_numbers = arguments.xyz is not None or arguments.rpy is not None
    if has_numbers == (arguments.name is not None):
        raise InvalidInput('go where? NAME of a saved pose; or --xyz X Y Z, --rpy R P Y, or both')
    if arguments.name is not None:
        return str(arguments.name)
    units = units_of(arguments)
    named: dict[str, float] = {}
    if arguments.xyz is not None:
        named |= dict(zip('xyz', (v / units.per_metre for v in arguments.xyz), strict=True))
    if arguments.rpy is not None:
        turns = (v / units.per_radian for v in arguments.rpy)
        named |= dict(zip(('roll', 'pitch', 'yaw'), turns, strict=True))
    return moved_to(robot.target, named)


def is_out_of_reach(robot: 'Robot', goal: Pose | str) -> bool:
    """Whether the machine file says so; False where it is not on this computer."""
    with suppress(ConfigError, TimedOut):
        return not robot.reach(goal).is_reachable
    return False


def home(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Moves home and measures the pose."""
    robot.home()
    return pose(robot, arguments)


def park(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """Moves to park and measures the pose."""
    robot.park()
    return pose(robot, arguments)


def pose(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """The measured pose."""
    measured = robot.pose
    answer = {'namespace': robot.namespace, 'pose': for_programs(measured)}
    return answer, units_of(arguments).pose(measured)


def joints_asked(words: Sequence[str], kinds: Mapping[str, str], units: Units) -> dict[str, float]:
    """NAME=Q of each joint, in SI; InvalidInput names the word that is none."""
    named: dict[str, float] = {}
    for word in words:
        name, _, number = word.partition('=')
        if name not in kinds:
            known = ', '.join(kinds)
            raise InvalidInput(f'--set {shown(word)}: needs NAME=Q, with one of {known}')
        if name in named:
            raise InvalidInput(f'--set: joint {name} is named twice')
        named[name] = checked(name, number) / units.factor(kinds[name])
    return named


def joints(robot: 'Robot', arguments: argparse.Namespace) -> Answer:
    """The measured joints, after a move of those of --set."""
    units, kinds = units_of(arguments), robot.limits.units
    if arguments.named:
        robot.move_joints(joints_asked(arguments.named, kinds, units))
    measured = robot.joints
    width = max(12, *map(len, measured))
    lines = [
        f'{name:<{width}} {units.quantities([position], kind):>16}'
        for name, position in measured.items()
        for kind in [kinds.get(name, '')]
    ]
    names, positions = list(measured), list(measured.values())
    answer = {'namespace': robot.namespace, 'joints': {'names': names, 'positions': positions}}
    return answer, lines
