"""`hexarm stop [NAMESPACE]`: the emergency stop, sent before anything else.

First to a bridge of this computer, for which nothing has to be found. Then over ROS, as soon as a
subscriber is there; the machine's state is only the confirmation. Modules are imported as late
as can be: a busy computer takes a second for ROS alone, and discovery goes on meanwhile.
"""

import argparse
import json
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from bridge.stop_socket import domain_here, send_stop, stop_address
from hexarm.cli.statuses import REFUSED
from hexarm.namespaces import NoMachine, namespace_of, no_machine_in
from manipulator.states import MachineState

if TYPE_CHECKING:
    from diagnostic_msgs.msg import DiagnosticStatus

FOUND_WITHIN = 8.0
"""Seconds in which a running machine is found and its state received."""

OBEYED_WITHIN = 3.0
"""Seconds from the first STOP until the machine must have confirmed it."""

AGAIN_AFTER = 0.1
"""Seconds from one STOP to the next, as long as it has not."""

STOPPED = MachineState.STOPPED


class Button(Protocol):
    """A node that publishes `emergency_stop` and receives `machine_state`."""

    @property
    def subscribers(self) -> int: ...  # noqa: D102
    @property
    def state(self) -> tuple[str, str] | None:
        """The machine state and its reason; None before the first."""

    def publish(self) -> None: ...  # noqa: D102
    def wait(self) -> None: ...  # noqa: D102


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('stop')
    parser.add_argument(
        'namespace', nargs='?', type=namespace_of, default='hexapod', help='default: hexapod'
    )
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Stops; status 0 when that is confirmed, 2 when it is not, 1 without a machine."""
    space = arguments.namespace
    send_stop(stop_address(f'/{space}/serial_bridge', domain_here()))
    with StopNode(space) as button:
        is_confirmed = press(button)
        if button.state is None:
            raise NoMachine(button.no_machine())
    state, reason = button.state
    if arguments.json:
        print(json.dumps({'namespace': f'/{space}', 'state': state, 'reason': reason}))
        return 0 if is_confirmed else REFUSED
    if is_confirmed:
        print(f'/{space}: machine stopped. Inspect the machine, then: hexarm clear {space}')
        return 0
    print(
        f'hexarm: STOP is sent, but not confirmed within {OBEYED_WITHIN:g} s: machine {state}'
        f'{f": {reason}" if reason else ""}. The bridge keeps it until it is cleared; if the '
        "machine moves, switch off its drives' supply",
        file=sys.stderr,
    )
    return REFUSED


def press(button: Button, now: Callable[[], float] = time.monotonic) -> bool:
    """Publishes STOP until the machine has confirmed it; False where it does not in time.

    At once to each subscriber that appears, since the first may be a recorder. A machine that was
    stopped before is stopped once more.
    """
    begun = now()
    first = last = None
    before = 0
    while True:
        time_now, subscribers = now(), button.subscribers
        is_due = last is not None and time_now > last + AGAIN_AFTER
        if subscribers > before or is_due:
            button.publish()
            first, last = first or time_now, time_now
        before = subscribers
        button.wait()
        if first is not None and button.state is not None:
            if button.state[0] == STOPPED:
                return True
            if time_now > first + OBEYED_WITHIN:
                return False
        elif time_now > begun + FOUND_WITHIN:
            return False


class StopNode:
    """The button as a node, alive while it is open as a context manager."""

    def __init__(self, namespace: str) -> None:
        import rclpy  # noqa: PLC0415 (needs ROS)
        from rclpy.node import Node  # noqa: PLC0415
        from rclpy.signals import SignalHandlerOptions  # noqa: PLC0415

        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        self._node = Node(
            'hexarm', namespace=namespace, enable_rosout=False, start_parameter_services=False
        )
        self._connect()

    def _connect(self) -> None:
        from std_msgs.msg import Bool  # noqa: PLC0415, I001 (what stops comes before what confirms)
        from manipulator.nodes.qos import EVERY_WORD, LATCHED  # noqa: PLC0415

        self._stop = Bool(data=True)
        self._stops = self._node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
        from diagnostic_msgs.msg import DiagnosticStatus  # noqa: PLC0415
        from rclpy.executors import SingleThreadedExecutor  # noqa: PLC0415

        self._state: DiagnosticStatus | None = None
        self._node.create_subscription(DiagnosticStatus, 'machine_state', self._note, LATCHED)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)

    def __enter__(self) -> 'StopNode':
        """The button itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Leaves the graph."""
        from rclpy.utilities import try_shutdown  # noqa: PLC0415

        self._executor.shutdown()
        self._node.destroy_node()
        try_shutdown()

    @property
    def subscribers(self) -> int:
        """How many are connected."""
        return int(self._stops.get_subscription_count())

    @property
    def state(self) -> tuple[str, str] | None:
        """The machine's last state and its reason; None before the first."""
        if self._state is None:
            return None
        reason = {pair.key: pair.value for pair in self._state.values}.get('reason', '')
        return self._state.message, reason

    def publish(self) -> None:
        """One STOP."""
        self._stops.publish(self._stop)

    def wait(self) -> None:
        """Receives messages for a moment."""
        self._executor.spin_once(timeout_sec=0.005)

    def no_machine(self) -> str:
        """That no machine is here, and where others are."""
        names = [name for name, _ in self._node.get_topic_names_and_types()]
        there = [name for name in names if self._node.count_publishers(name)]
        domain = int(self._node.context.get_domain_id())
        return no_machine_in(self._node.get_namespace(), there, domain)

    def _note(self, state: 'DiagnosticStatus') -> None:
        self._state = state
