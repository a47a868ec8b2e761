"""`hexarm up robocake`: a whole graph, servos enabled, until Ctrl-C; then it parks."""

import argparse
import contextlib
import glob
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from bridge.fake.servo import PLANTS, SERVO
from hexarm.cli.running.leaving import leave
from hexarm.graph import (
    Executable,
    Graph,
    NodeDied,
    board_process,
    check_alive,
    check_topic,
    link_folder,
    node_processes,
    ros_arguments,
    wait_for,
)
from hexarm.machines import described, family, load, read
from hexarm.namespaces import NAMESPACE
from hexarm.panel_process import panel_process, panel_words
from manipulator.errors import Refused
from manipulator.nodes.stop_signal import Interrupted, StopSignal
from manipulator.states import MachineState

if TYPE_CHECKING:
    from hexarm.client import Client

SETTLES = 1.0
"""Seconds within which an earlier STOP is sent to the board, and obeyed."""
MACHINES = {'hexapod': 'robocake', 'arm': 'arm_6r'}
BOARDS = ('fake', 'simavr')
"""In place of a port."""
NAME = 'a shipped name or the path of a machine file'
PLANT = 'what a simulated board moves: servos, or rigid bodies with loads (mujoco)'
PORT = (
    "a device, 'fake' (default) or 'simavr'; with driver: topic the topic of its driver's joint "
    "states, or 'fake'"
)
SHORT = ', '.join(f'{kind} is short for {name}' for kind, name in MACHINES.items())


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('up')
    parser.add_argument('name', metavar='MACHINE', help=f'{NAME}; {SHORT}')
    parser.add_argument('--machine', help=f'{NAME}, after hexapod or arm')
    parser.add_argument('--port', default='fake', help=PORT)
    parser.add_argument('--plant', choices=PLANTS, default=SERVO, help=PLANT)
    parser.add_argument('--namespace', help='default: hexapod or arm, as the machine is')
    parser.add_argument('--separate', action='store_true', help='one process for each node')
    parser.add_argument('--panel', action='store_true', help='with a web page to watch and drive')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Runs the graph; status 0 after Ctrl-C, 1 when a part of it ended or did not get ready."""
    from hexarm.client import Client  # noqa: PLC0415 (needs ROS, which `hexarm ik` does not)
    from hexarm.nodes import import_machine_nodes  # noqa: PLC0415 (as above)

    machine = arguments.machine or MACHINES.get(arguments.name, arguments.name)
    check(arguments.name, machine, arguments.namespace)
    check_port(arguments.port, machine, arguments.plant)
    namespace = arguments.namespace or family(machine)
    pages = [panel_process(machine)] if arguments.panel else []
    stop = StopSignal()
    parts = Parts(machine, namespace, arguments.port, arguments.plant)

    def interrupt() -> None:
        stop.check()
        parts.check_alive()

    with parts, Client(namespace, interrupt) as client:
        parts.start_processes([*parts.board, *pages])
        if not arguments.separate:
            import_machine_nodes()  # while this node finds the others
        client.refuse_second()
        print(described(machine), flush=True)
        parts.start_nodes(arguments.separate)
        try:
            enable(client, namespace)
            print(_welcome(namespace, machine, arguments.port), flush=True)
            for page in pages:
                print(f'The panel is on {panel_words(page)}', flush=True)
            _watch(client)
        except Interrupted:
            stop.is_set = False
            leave(client, stop, machine)
    return 0


class Parts:
    """Everything that runs for one machine: processes, and nodes in this one.

    A context manager that leaves none behind. The context of ROS that nodes and client share is
    made when it is entered.
    """

    def __init__(self, machine: str, namespace: str, port: str, plant: str) -> None:
        self._stack = contextlib.ExitStack()
        self._machine, self._namespace, self._port = machine, namespace, port
        self._plant = plant
        self._link: Path | None = None
        self._graphs: list[Graph] = []
        self._are_nodes_alive: Callable[[], bool] = lambda: True
        self.board: list[Executable] = []

    def __enter__(self) -> 'Parts':
        """Makes the folder of the board's port, and the context."""
        from manipulator.nodes.run import context  # noqa: PLC0415 (needs ROS)

        link = Path(self._stack.enter_context(link_folder())) / 'board'
        self.board = board_process(self._machine, self._port, link, self._plant)
        self._link = link if self.board else None
        parameters = {'machine': self._machine, 'port': str(self._link or self._port)}
        self._stack.enter_context(context(ros_arguments(self._namespace, parameters)))
        return self

    def __exit__(self, *exception: object) -> None:
        """Ends them, the ones that were started last first."""
        self._stack.close()

    def start_processes(self, processes: list[Executable]) -> None:
        """Starts processes that are watched from now on."""
        self._graphs.append(self._stack.enter_context(Graph(processes, self._namespace)))

    def start_nodes(self, is_separate: bool) -> None:
        """The machine's four nodes: in this process, or as one process each."""
        if is_separate:
            self.start_processes(node_processes(self._machine, self._port, self._link))
            return
        from hexarm.nodes import machine_nodes  # noqa: PLC0415 (as above)
        from manipulator.nodes.run import spinning  # noqa: PLC0415

        wait_for(self._link)
        self._are_nodes_alive = self._stack.enter_context(spinning(machine_nodes()))

    def check_alive(self) -> None:
        """Raises NodeDied when one of them has ended."""
        for graph in self._graphs:
            check_alive(graph)
        if not self._are_nodes_alive():
            raise NodeDied('the nodes ended by an error; stopping the others')


def check(name: str, machine: str, namespace: str | None) -> None:
    """Raises Refused or ConfigError for what would only fail once the nodes have started.

    `name` is what the user called the machine, or 'hexapod' or 'arm' for one of the kind.
    """
    if namespace is not None and NAMESPACE.fullmatch(namespace) is None:
        raise Refused(f'namespace {namespace!r} is not a ROS name: letters, digits, _ and /')
    load(machine)
    if name not in MACHINES and machine != name:
        raise Refused(f'both {name!r} and --machine {machine}: name one machine')
    if name in MACHINES and family(machine) != name:
        raise Refused(f'{machine} is a {read(machine).kind}: hexarm up {machine}')


def check_port(port: str, machine: str, plant: str) -> None:
    """Raises Refused for a port that does not exist, or that this user may not open."""
    if read(machine).driver == 'topic':
        check_topic(machine, port, plant)
        return
    if port in BOARDS:
        return
    if not os.path.exists(port):
        there = sorted(glob.glob('/dev/serial/by-id/*') + glob.glob('/dev/tty[AU][CS][MB]*'))
        raise Refused(
            f'port {port} does not exist: is the board connected? '
            f'Ports: {", ".join(there) or "none"}, or {" or ".join(BOARDS)}'
        )
    if not os.access(port, os.R_OK | os.W_OK):
        raise Refused(f'port {port} is not permitted: add yourself to the group dialout')


def enable(client: 'Client', namespace: str) -> None:
    """Energises the servos; a machine that is stopped waits until it is cleared."""
    space = namespace.strip('/')
    while True:
        print('enabling', flush=True)
        try:
            client.enable(report=partial(print, flush=True))
            return
        except Refused:
            client.spin(SETTLES)
            if client.machine_state.message != MachineState.STOPPED:
                raise
        print(
            f'{client.summary}. It is enabled once you have looked at it and called\n'
            f'  hexarm clear {space}\n'
            f'or  ros2 service call /{space}/serial_bridge/clear_fault std_srvs/srv/Trigger',
            flush=True,
        )
        while client.machine_state.message == MachineState.STOPPED:
            client.spin(0.2)


def _watch(client: 'Client') -> None:
    """Prints every change of the machine's state until something ends it."""
    last = client.machine_state.message
    while True:
        client.spin(0.2)
        if client.machine_state.message != last:
            last = client.machine_state.message
            print(client.summary, flush=True)


def _welcome(namespace: str, machine: str, port: str) -> str:
    end = 'leaves it where it is' if read(machine).driver == 'topic' else 'parks it'
    return (
        f'{machine} is up on {port} and enabled, in namespace /{namespace}. Ctrl-C {end}.\n'
        f'Publish geometry_msgs/PoseStamped on /{namespace}/goal_pose and watch '
        f'/{namespace}/pose and /{namespace}/motion_status.'
    )
