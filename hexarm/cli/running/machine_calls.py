"""`hexarm enable|disable|clear [NAMESPACE]`: a machine's services, without `ros2`."""

import argparse
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from hexarm.cli.answers import Answer, answering
from hexarm.namespaces import namespace_of
from manipulator.errors import Refused
from manipulator.states import MachineState

if TYPE_CHECKING:
    from hexarm.client import Client

SETTLES = 0.5
"""Seconds in which the new state is received, too."""


CALLS: 'dict[str, Callable[[Client], str | None]]' = {
    'enable': lambda client: client.enable(),
    'disable': lambda client: client.disable(),
    'clear': lambda client: client.trigger('serial_bridge/clear_fault'),
}


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommands."""
    for name, act in CALLS.items():
        parser = commands.add_parser(name)
        parser.add_argument(
            'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
        )
        parser.add_argument('--json', action='store_true', help='answer for programs')
        parser.set_defaults(run=answering(partial(answer, act)))


def answer(act: 'Callable[[Client], str | None]', arguments: argparse.Namespace) -> Answer:
    """Calls; the answer is the machine's state. Refused with the remedy, where there is one."""
    from hexarm.client import Client  # noqa: PLC0415 (needs ROS)

    space = arguments.namespace
    with Client(space) as client:
        client.await_machine()
        try:
            text = act(client)
        except Refused as error:
            raise Refused(f'{error}{remedy(client.machine_state.message, space)}') from error
        client.spin(SETTLES)
        state = client.machine_state.message
        words = (f' ({text})' if text else '') + remedy(state, space)
        reported = {
            'namespace': f'/{space}',
            'state': state,
            'motion': client.motion_status.message,
            'answer': text or '',
        }
        return reported, [f'/{space}: {client.summary}{words}']


def remedy(state: str, namespace: str) -> str:
    """What ends a stop or a fault, where the machine has one."""
    if state not in (MachineState.STOPPED, MachineState.FAULT):
        return ''
    return f'. Inspect the machine, then: hexarm clear {namespace}'
