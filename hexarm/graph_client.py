"""A node that watches one machine's graph, waits for it and calls its services."""

import contextlib
import signal
import threading
import time
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any, TypeVar

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown
from std_srvs.srv import SetBool, Trigger

from hexarm.namespaces import NoMachine, no_machine_in
from manipulator.errors import Refused, TimedOut
from manipulator.nodes.qos import LATCHED
from manipulator.nodes.run import leaving_within
from manipulator.states import UNKNOWN

MOST_REQUESTS, ANSWERED_WITHIN = 4, 4.0
FOUND_WITHIN = 8.0
"""Seconds in which the bridge of a running machine publishes its state."""
GRAPH_FOUND_WITHIN = 0.7
"""Seconds in which a graph that runs already is found: at most 0.46 s in 64 tries."""
NODES = ('trajectory', 'ik', 'pose', 'serial_bridge')
"""Nodes of which a namespace has one; a fake board may be there for `--port` to name."""
LEAVES_WITHIN = 10.0
"""Seconds until a process that cannot leave the graph is ended: see leaving_within."""

Self = TypeVar('Self', bound='GraphClient')


class GraphClient:
    """A node in `namespace`, spun only while it waits; a context manager.

    `interrupt`, called at every wait, may raise to end it (a node has died, Ctrl-C).
    """

    def __init__(self, namespace: str, interrupt: Callable[[], None] = lambda: None) -> None:
        self._owns_context = not rclpy.ok()
        if self._owns_context:
            rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        self.node = Node('hexarm', namespace=namespace, start_parameter_services=False)
        self._joined_at = time.monotonic()
        self.machine_state = DiagnosticStatus(message=UNKNOWN)
        self.motion_status = DiagnosticStatus()
        self.diagnostics: dict[str, DiagnosticStatus] = {}
        self._states_received = 0
        self._interrupt = interrupt
        # Not the EventsExecutor: its queue grows without bound as long as nobody spins.
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        subscribe = self.node.create_subscription
        subscribe(DiagnosticStatus, 'machine_state', self._on_machine_state, LATCHED)
        subscribe(DiagnosticStatus, 'motion_status', self._on_motion_status, LATCHED)
        subscribe(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)

    def __enter__(self: Self) -> Self:
        """The client itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Leaves the graph."""
        with leaving_within(LEAVES_WITHIN):
            # Shutting down releases the node's handles: without it the node stays in the graph.
            self._executor.shutdown()
            self.node.destroy_node()
            if self._owns_context:
                try_shutdown()

    def spin(self, seconds: float) -> None:
        """Receives messages for a while."""
        end = time.monotonic() + seconds
        while True:
            self._interrupt()
            left = end - time.monotonic()
            if left <= 0:
                return
            with _interrupt_after() if self._owns_context else contextlib.nullcontext():
                self._executor.spin_once(timeout_sec=min(left, 0.05))

    def wait(
        self,
        what: str,
        is_so: Callable[[], bool],
        seconds: float,
        progress: Callable[[], object] = lambda: None,
    ) -> None:
        """Receives messages until `is_so`; TimedOut names what did not come.

        The seconds begin again whenever `progress` changes.
        """
        end, before = time.monotonic() + seconds, progress()
        while not is_so():
            if time.monotonic() > end:
                raise TimedOut(
                    f'timed out after {seconds:g} s, waiting for {what} ({self.summary})'
                )
            self.spin(0.005)
            if (now := progress()) != before:
                end, before = time.monotonic() + seconds, now

    @property
    def summary(self) -> str:
        """Machine state and motion status in a few words."""
        reason = {v.key: v.value for v in self.machine_state.values}.get('reason', '')
        state = f'{self.machine_state.message}: {reason}' if reason else self.machine_state.message
        motion = f', motion {self.motion_status.message}' if self.motion_status.message else ''
        return f'machine {state}{motion}'

    @property
    def topics(self) -> list[str]:
        """Every topic that has a publisher."""
        names = [name for name, _ in self.node.get_topic_names_and_types()]
        return [name for name in names if self.node.count_publishers(name)]

    @property
    def domain(self) -> int:
        """The ROS domain."""
        return int(self.node.context.get_domain_id())

    def motion(self, key: str) -> str:
        """One of the values of motion_status, '' before the first."""
        return str({v.key: v.value for v in self.motion_status.values}.get(key, ''))

    def report_of(self, node: str) -> DiagnosticStatus:
        """The last report of one of the machine's nodes; TimedOut where none comes."""
        name = f'{self.node.get_namespace()}/{node}'.strip('/')
        self.wait(f'diagnostics of {node}', lambda: name in self.diagnostics, 5.0)
        return self.diagnostics[name]

    def await_machine(self) -> None:
        """Waits for the machine's state; NoMachine names the namespace and domain."""
        try:
            self.wait('a machine', lambda: self.machine_state.message != UNKNOWN, FOUND_WITHIN)
        except TimedOut as error:
            space = self.node.get_namespace()
            raise NoMachine(no_machine_in(space, self.topics, self.domain)) from error

    def refuse_second(self) -> None:
        """Raises Refused where a graph runs in this namespace: both would receive every call.

        It takes GRAPH_FOUND_WITHIN from when this node joined the graph: what is done meanwhile
        costs nothing.
        """
        self.spin(self._joined_at + GRAPH_FOUND_WITHIN - time.monotonic())
        found = self.node.get_node_names_and_namespaces()
        if any(name in NODES and space == self.node.get_namespace() for name, space in found):
            raise Refused(
                f'a graph runs in {self.node.get_namespace()} already: end it, or take another '
                'namespace or ROS_DOMAIN_ID (other computers on the network count)'
            )

    def trigger(self, service: str) -> str:
        """Calls a Trigger service of the graph; Refused with its reason when it fails."""
        return self._call(Trigger, service, Trigger.Request())

    def switch(self, service: str, is_on: bool) -> str:
        """Calls a SetBool service of the graph; Refused with its reason when it fails."""
        return self._call(SetBool, service, SetBool.Request(data=is_on))

    def _call(self, kind: type, name: str, request: Any) -> str:
        response = self.ask(kind, name, request)
        if not response.success:
            raise Refused(f'{name}: {response.message}')
        return str(response.message)

    def ask(self, kind: type, name: str, request: Any) -> Any:
        """The response of a service of the graph."""
        client = self.node.create_client(kind, name)
        try:
            self.wait(f'service {name}', client.service_is_ready, seconds=10.0)
            return self.answer_of(client, request, f'an answer of {name}')
        finally:
            self.node.destroy_client(client)

    def answer_of(self, client: Any, request: Any, what: str) -> Any:
        """The service's response; requested again where it is lost, as just after discovery."""
        for _ in range(MOST_REQUESTS):
            future = client.call_async(request)
            with contextlib.suppress(TimedOut):
                self.wait(what, future.done, ANSWERED_WITHIN)
                return future.result()
        raise TimedOut(f'no answer: {what} was requested {MOST_REQUESTS} times ({self.summary})')

    def _on_machine_state(self, message: DiagnosticStatus) -> None:
        self.machine_state = message
        self._states_received += 1

    def _on_motion_status(self, message: DiagnosticStatus) -> None:
        self.motion_status = message

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for entry in message.status:
            self.diagnostics[entry.name] = entry


@contextlib.contextmanager
def _interrupt_after() -> Iterator[None]:
    """What Ctrl-C does (KeyboardInterrupt, or a handler of the program) happens after the block.

    In the middle of rclpy a KeyboardInterrupt may be lost (Python drops what `Future.__del__`
    raises), turn into a RuntimeError, or leave the node without any more callbacks. For a context
    of our own: rclpy's handler for another one is none of Python's, and could not be put back.
    """
    handler = signal.getsignal(signal.SIGINT)
    if not callable(handler) or threading.current_thread() is not threading.main_thread():
        yield
        return
    received: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda *signalled: received.append(signalled))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if received:
            handler(*received[0])
