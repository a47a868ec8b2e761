"""How `hexarm up` leaves a machine: parked and released, or where it is."""

import contextlib
import sys
from typing import TYPE_CHECKING

from hexarm.machines import read
from manipulator.errors import ManipulatorError, Refused, TimedOut
from manipulator.nodes.stop_signal import Interrupted, StopSignal
from manipulator.states import UNKNOWN, MachineState, MotionMode

if TYPE_CHECKING:
    from hexarm.client import Client

RESTS_WITHIN = 1.0
"""Seconds in which a machine is braked."""
SERVOS_OFF = (
    UNKNOWN,
    MachineState.DISCONNECTED,
    MachineState.BOOTING,
    MachineState.DISARMED,
)
AT_REST = (MotionMode.HOLD, MotionMode.DISABLED)


def leave(client: 'Client', stop: StopSignal, machine: str) -> None:
    """Parks; a machine whose driver keeps the joints where they are is left there."""
    if read(machine).driver == 'topic':
        with contextlib.suppress(ManipulatorError):
            client.trigger('trajectory/stop')
            client.wait('rest', lambda: client.motion('mode') in AT_REST, RESTS_WITHIN)
        client.disable()
        print('no more joint commands: the driver keeps the joints where they are', flush=True)
    else:
        park(client, stop)


def park(client: 'Client', stop: StopSignal) -> None:
    """Goes to park and switches the servos off; where it cannot, the user confirms the release.

    In a terminal the answer is another Ctrl-C. Without one the servos stay on: what the board then
    does is set by `on_link_loss` of the machine file.
    """
    if client.machine_state.message in SERVOS_OFF:
        return
    try:
        _go_to_park(client)
    except Interrupted:
        print('not parked: interrupted again', flush=True)
    except ManipulatorError as error:
        print(f'not parked: {error}', flush=True)
        if not _may_let_go(client, stop):
            return
    stop.is_set = False
    try:
        client.disable()
    except ManipulatorError as error:
        print(f'the servos are still on: {error}')


def _go_to_park(client: 'Client') -> None:
    """Raises Refused, Stopped or TimedOut where it does not get there."""
    if client.machine_state.message != MachineState.ENABLED:
        raise Refused(f'the machine is {client.machine_state.message}')
    print('parking; Ctrl-C again switches the servos off where they are', flush=True)
    with contextlib.suppress(TimedOut):
        client.wait(
            'the pose', lambda: client.motion('mode') not in ('', MotionMode.DISABLED), 1.0
        )
    client.park()


def _may_let_go(client: 'Client', stop: StopSignal) -> bool:
    """Whether a user at a terminal confirms that the servos may be switched off here."""
    if not sys.stdin.isatty():
        print('the servos stay on: the board acts as set by on_link_loss', flush=True)
        return False
    print('The servos hold. Ctrl-C switches them off here: an arm may fall.', flush=True)
    stop.is_set = False
    try:
        while client.machine_state.message not in SERVOS_OFF:
            client.spin(0.2)
    except Interrupted:
        return True
    return False
