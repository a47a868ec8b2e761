"""`hexarm demo`: both machines' graphs on fake boards, goals, a gamepad, a table and a picture."""

import argparse
import contextlib
import json
import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from hexarm import use_own_domain
from hexarm.cli.answers import picture_file
from hexarm.cli.statuses import INTERRUPTED
from hexarm.demo.report import Curve, Observation, Result, measure
from hexarm.graph import Executable, Graph, check_alive, link_folder, machine_graph
from hexarm.machines import load
from hexarm.panel_process import offered_panel
from manipulator.errors import Refused, Stopped, TimedOut
from manipulator.nodes.stop_signal import Interrupted, StopSignal
from manipulator.pose import Pose
from manipulator.states import MotionMode

if TYPE_CHECKING:
    from hexarm.client import Client
    from hexarm.demo.arm_report import ArmResult
    from hexarm.demo.recording import Recorder

MACHINE = 'robocake'
CENTRE = np.array([0.0, 0.0, 0.045])
RADIUS, TILT, PERIOD, TURNS = 0.008, math.radians(4.0), 4.0, 2
STREAM_PERIOD = 0.02
PAUSE = 0.4
Observed = TypeVar('Observed')


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('demo')
    parser.add_argument(
        '--picture', type=picture_file, default=Path('demo.png'), help='where to save it'
    )
    parser.add_argument('--json', action='store_true', help='the table for programs')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Runs the demonstration; status 0 when it went through, 130 after Ctrl-C."""
    if not arguments.json:
        return demonstrate(arguments, report)
    # What is said meanwhile goes to the error output.
    with contextlib.redirect_stdout(sys.stderr):
        return demonstrate(arguments, report_as_json)


def demonstrate(
    arguments: argparse.Namespace, report: 'Callable[[Result, ArmResult, Path], None]'
) -> int:
    """Drives both machines, draws, and has the results reported."""
    from hexarm.demo import arm as demo_arm  # noqa: PLC0415 (need ROS)
    from hexarm.demo import arm_report as demo_arm_report  # noqa: PLC0415
    from hexarm.demo.picture import draw  # noqa: PLC0415 (needs matplotlib)

    picture: Path = arguments.picture
    use_own_domain()
    stop = StopSignal()
    try:
        echo('starting the graph: fake_hardware, serial_bridge, ik, trajectory, pose')
        observation = on_graph('hexapod', MACHINE, [], stop, tour)
        arm = load(demo_arm.MACHINE)
        echo('starting the same graph for the arm, and joy_teleop')
        arm_observation = on_graph(
            'arm',
            demo_arm.MACHINE,
            [demo_arm.teleop()],
            stop,
            lambda client: demo_arm.arm_tour(client, arm, echo),
        )
    except Interrupted:
        echo('interrupted: stopping the graph')
        return INTERRUPTED
    result = measure(observation, load(MACHINE).kinematics)
    arm_result = demo_arm_report.measure_arm(arm_observation, arm.kinematics)
    draw(result, arm_result, arm, picture)
    report(result, arm_result, picture)
    return 0


def on_graph(
    kind: str,
    machine: str,
    others: list[Executable],
    stop: StopSignal,
    tour: 'Callable[[Client], Observed]',
) -> Observed:
    """Runs a machine's graph and a tour on it; Interrupted after Ctrl-C."""
    from hexarm.client import Client  # noqa: PLC0415 (needs ROS)

    with link_folder() as folder:
        nodes = machine_graph(machine, 'fake', Path(folder) / 'board')
        with Graph(
            [*nodes, *others, *offered_panel(machine, echo)], kind, log_level='error'
        ) as graph:

            def interrupt() -> None:
                stop.check()
                check_alive(graph)

            with Client(kind, interrupt) as client:
                observed = tour(client)
                put_away(client)
                return observed


def put_away(client: 'Client') -> None:
    """Parks, where the computer lets it, and switches the servos of the fake board off."""
    with contextlib.suppress(Refused, Stopped, TimedOut):
        client.park()
    client.disable()


def tour(client: 'Client') -> Observation:
    """Goal moves, a goal out of reach and a circle with a tilt, from outside as a user would."""
    from hexarm.demo.recording import Recorder  # noqa: PLC0415 (needs ROS)

    echo('waiting for the board, then energising the servos one by one')
    client.enable()
    recorder = Recorder(client)
    for text, goal in moves():
        echo(text)
        recorder.line_to(goal)
        drive(client, goal)
        client.spin(PAUSE)
    try:
        echo('a goal out of reach: x = 40 mm')
        drive(client, Pose.from_xyz_rpy((0.04, 0.0, 0.045)), is_possible=False)
    except Refused as refusal:
        echo(f'  {refusal}')
    echo(f'a circle of {RADIUS * 1e3:g} mm with a turning tilt of {math.degrees(TILT):g}°')
    stream(client, recorder)
    return recorder.observation(load(MACHINE).kinematics)


def drive(client: 'Client', goal: Pose, *, is_possible: bool = True) -> None:
    """Goes to the goal; again where a busy computer stopped the machine, in motion or before.

    A goal that is possible is refused only by a machine that is not ready.
    """
    busy = (Stopped, TimedOut, Refused) if is_possible else (Stopped, TimedOut)
    for tries_left in (2, 1, 0):
        client.wait('the machine', lambda: client.motion('mode') != MotionMode.DISABLED, 10.0)
        try:
            client.go_to(goal)
        except busy as reason:
            if not tries_left:
                raise
            echo(f'  {reason}: once more')
        else:
            return


def moves() -> Iterator[tuple[str, Pose]]:
    """The goal moves of the tour; the last leads to where the circle begins."""
    yield 'up by 8 mm', Pose.from_xyz_rpy((0.0, 0.0, 0.049))
    yield 'turn by 8° about z', Pose.from_xyz_rpy((0.0, 0.0, 0.045), (0.0, 0.0, 0.14))
    yield 'to where the circle begins', circle(0.0)


def circle(seconds: float) -> Pose:
    """The circle's pose: it goes round once a period, and the platform leans outwards."""
    angle = 2 * math.pi * seconds / PERIOD
    c, s = math.cos(angle), math.sin(angle)
    return Pose.from_xyz_rpy(CENTRE + RADIUS * np.array([c, s, 0.0]), (-TILT * s, TILT * c, 0.0))


def stream(client: 'Client', recorder: 'Recorder') -> None:
    """Publishes the circle as a stream of goals, each where the platform should be by now."""
    begin = time.time()
    recorder.follow(Curve(circle, begin, PERIOD * TURNS))
    count = round(PERIOD * TURNS / STREAM_PERIOD)
    for k in range(1, count + 1):
        client.spin(begin + k * STREAM_PERIOD - time.time())
        client.publish_goal(circle(k * STREAM_PERIOD))
        if k % (count // 8) == 0:
            echo(f'  {100 * k // count} %')
    client.spin(0.5)


def report(result: Result, arm_result: 'ArmResult', picture: Path) -> None:
    """Prints the table."""
    for title, rows in (('RoboCake', result.rows()), ('six-axis arm', arm_result.rows())):
        print(f'\n{title}')
        for name, value in rows:
            print(f'  {name:<40} {value}')
    print(f'\nThe picture is in {picture}.')
    print('To drive it yourself, in a browser: hexarm up hexapod --panel')


def report_as_json(result: Result, arm_result: 'ArmResult', picture: Path) -> None:
    """Prints the table for programs."""
    tables = {'robocake': dict(result.rows()), 'arm': dict(arm_result.rows())}
    print(json.dumps(tables | {'picture': str(picture)}, ensure_ascii=False), file=sys.__stdout__)


def echo(text: str) -> None:
    """Prints one line of progress at once."""
    print(text, flush=True)
