"""`hexarm foxglove [NAMESPACE]`: a machine's messages to Foxglove, live, until Ctrl-C."""

import argparse
import math

from hexarm.namespaces import NoMachine, namespace_of
from hexarm.recording.topics import TopicSelection, nothing_recorded
from manipulator.formatting import shown
from manipulator.nodes.stop_signal import StopSignal

LAST_PORT = 65535


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('foxglove')
    parser.add_argument(
        'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
    )
    parser.add_argument('--host', default='127.0.0.1', help='0.0.0.0 for every network')
    parser.add_argument(
        '--port', type=tcp_port, default=8765, help='default: 8765; 0: any that is free'
    )
    parser.set_defaults(run=run)


def tcp_port(word: str) -> int:
    """A TCP port's number; 0 lets the system choose one."""
    if not (word.isascii() and word.isdigit() and int(word) <= LAST_PORT):
        raise argparse.ArgumentTypeError(f'{shown(word)}: needs a port from 0 to {LAST_PORT}')
    return int(word)


def run(arguments: argparse.Namespace) -> int:
    """Serves; status 0 after Ctrl-C, 1 where no machine comes."""
    from hexarm.recording.foxglove_server import FoxgloveServer  # noqa: PLC0415 (needs the SDK)
    from hexarm.recording.session import Control, record  # noqa: PLC0415 (needs ROS)

    namespace = arguments.namespace
    selection, stop = TopicSelection(namespace), StopSignal()
    with FoxgloveServer(f'hexarm /{namespace}', arguments.host, arguments.port) as server:
        control = Control(
            math.inf,
            stop.check,
            lambda: print(
                f'/{namespace} is on {server.address}: in Foxglove, "Open connection"; '
                'Ctrl-C ends it',
                flush=True,
            ),
            lambda there, domain: print(
                f'{nothing_recorded(namespace, [], there, domain)}; still waiting, Ctrl-C ends it',
                flush=True,
            ),
        )
        there, domain = record(server, namespace, selection, control)
    if not stop.is_set:
        raise NoMachine(nothing_recorded(namespace, [], there, domain))
    return 0
