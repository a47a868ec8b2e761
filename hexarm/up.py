"""`hexarm up hexapod`: a whole graph, servos enabled, until Ctrl-C; then it parks."""

import argparse
import signal
from pathlib import Path
from typing import TYPE_CHECKING

from hexarm.graph import Graph, link_folder, machine_graph
from manipulator.errors import ManipulatorError

if TYPE_CHECKING:
    from hexarm.client import Client

MACHINES = {'hexapod': 'robocake', 'arm': 'arm_6r'}


class NodeDied(ManipulatorError):
    """A node of the graph has ended by itself."""


class Interrupted(ManipulatorError):
    """Somebody pressed Ctrl-C, or asked the process to end."""


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('up', help='start a whole graph and enable the servos')
    parser.add_argument('kind', choices=list(MACHINES))
    parser.add_argument('--machine', help='a shipped name or a path (default: the usual one)')
    parser.add_argument('--port', default='fake', help="a device, 'fake' (default) or 'simavr'")
    parser.add_argument('--namespace', help='default: hexapod or arm')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Runs the graph; status 0 after Ctrl-C, 1 when a node died or did not get ready."""
    from hexarm.client import Client  # noqa: PLC0415 (needs ROS, which `hexarm ik` does not)

    machine = arguments.machine or MACHINES[arguments.kind]
    namespace = arguments.namespace or arguments.kind
    stop = StopSignal()
    with link_folder() as folder:
        nodes = machine_graph(arguments.kind, machine, arguments.port, Path(folder) / 'board')
        with Graph(nodes, namespace) as graph:

            def interrupt() -> None:
                stop.check()
                check_alive(graph)

            with Client(namespace, interrupt) as client:
                try:
                    client.enable()
                    print(_welcome(namespace, machine, arguments.port), flush=True)
                    _watch(client)
                except Interrupted:
                    stop.is_set = False
                    park(client)
    return 0


class StopSignal:
    """SIGINT and SIGTERM as a flag, and as an exception at the next `check`."""

    def __init__(self) -> None:
        self.is_set = False
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self._set)

    def check(self) -> None:
        """Raises Interrupted after a signal."""
        if self.is_set:
            raise Interrupted('interrupted')

    def _set(self, number: int, frame: object) -> None:
        self.is_set = True


def check_alive(graph: Graph) -> None:
    """Raises NodeDied when a process of the graph has ended."""
    dead = graph.dead()
    if dead is not None:
        raise NodeDied(f'{dead}; stopping the others')


def park(client: 'Client') -> None:
    """Goes home and switches the servos off, as far as the machine still can."""
    if client.machine_state.message != 'enabled':
        return
    print('parking', flush=True)
    try:
        client.home()
        client.disable()
    except Interrupted:
        print('interrupted again: not parked')
    except ManipulatorError as error:
        print(f'not parked: {error}')


def _watch(client: 'Client') -> None:
    """Prints every change of the machine's state until something ends it."""
    last = client.machine_state.message
    while True:
        client.spin(0.2)
        if client.machine_state.message != last:
            last = client.machine_state.message
            print(client.summary, flush=True)


def _welcome(namespace: str, machine: str, port: str) -> str:
    return (
        f'{machine} is up on {port} and enabled, in namespace /{namespace}. Ctrl-C parks it.\n'
        f'Publish geometry_msgs/PoseStamped on /{namespace}/goal_pose and watch '
        f'/{namespace}/pose and /{namespace}/motion_status.'
    )
