"""`hexarm enable|disable|clear [NAMESPACE]`: a machine's services, without `ros2`."""

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from hexarm.cli.statuses import INTERRUPTED, REFUSED
from hexarm.cli.up import Interrupted, StopSignal
from hexarm.namespaces import namespace_of
from manipulator.errors import Refused
from manipulator.states import MachineState

if TYPE_CHECKING:
    from hexarm.client import Client

SETTLES = 0.5
"""Seconds in which the new state is received, too."""


@dataclass(frozen=True)
class Call:
    """One subcommand: its request to the machine, and the answer, if any."""

    name: str
    help: str
    act: 'Callable[[Client], object]'


CALLS = (
    Call(
        'enable',
        'servos on, one by one, to the park pose',
        lambda client: client.enable(),
    ),
    Call(
        'disable',
        'servos off: they hold nothing any more',
        lambda client: client.disable(),
    ),
    Call(
        'clear',
        'end a stop or a fault; nothing moves',
        lambda client: client.trigger('serial_bridge/clear_fault'),
    ),
)


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommands."""
    for call in CALLS:
        parser = commands.add_parser(call.name, help=call.help)
        parser.add_argument(
            'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
        )
        parser.set_defaults(run=partial(run, call))


def run(call: Call, arguments: argparse.Namespace) -> int:
    """Calls, and prints the machine's state; status 1 without a machine, 2 for a refusal."""
    from hexarm.client import Client  # noqa: PLC0415 (needs ROS)

    stop = StopSignal()
    try:
        with Client(arguments.namespace, stop.check) as client:
            client.await_machine()
            answer = call.act(client)
            client.spin(SETTLES)
            words = f' ({answer})' if answer else ''
            space = arguments.namespace
            print(f'/{space}: {client.summary}{words}{remedy(client, space)}')
    except Refused as error:
        print(f'hexarm: {error}{remedy(client, arguments.namespace)}', file=sys.stderr)
        return REFUSED
    except Interrupted:
        return INTERRUPTED
    return 0


def remedy(client: 'Client', namespace: str) -> str:
    """What ends a stop or a fault, where the machine has one."""
    if client.machine_state.message not in (MachineState.STOPPED, MachineState.FAULT):
        return ''
    return f'. Look at the machine, then: hexarm clear {namespace}'
