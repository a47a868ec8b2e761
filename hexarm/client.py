"""A client of one machine's graph: enables it, sends goals, receives their results."""

import contextlib
import time
from collections.abc import Callable
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown
from std_srvs.srv import SetBool, Trigger

from manipulator.errors import ManipulatorError, Refused, Stopped, TimedOut
from manipulator.nodes.messages import pose_message, seconds
from manipulator.nodes.path_goals import path_message
from manipulator.nodes.qos import COMMAND, LATCHED
from manipulator.pose import Pose
from manipulator.states import UNKNOWN, MachineState, MotionMode, MotionResult

MOST_REQUESTS, ANSWERED_WITHIN = 4, 4.0
DRIVEN_WITHIN = 15.0
"""Seconds until a machine whose servos are on takes goals: its nodes may still be starting."""


class Client:
    """A node in `namespace`, spun only while it waits; a context manager.

    `interrupt`, called at every wait, may raise to end it (a node has died, Ctrl-C).
    """

    def __init__(self, namespace: str, interrupt: Callable[[], None] = lambda: None) -> None:
        self._owns_context = not rclpy.ok()
        if self._owns_context:
            rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        self.node = Node('hexarm', namespace=namespace)
        self.machine_state = DiagnosticStatus(message=UNKNOWN)
        self.motion_status = DiagnosticStatus()
        self.diagnostics: dict[str, DiagnosticStatus] = {}
        self._states_received = 0
        self._setpoints: Any = None
        self._commanded: Any = None
        self._interrupt = interrupt
        self._executor = EventsExecutor()
        self._executor.add_node(self.node)
        self._goals = self.node.create_publisher(PoseStamped, 'goal_pose', COMMAND)
        self._paths = self.node.create_publisher(Path, 'goal_path', COMMAND)
        subscribe = self.node.create_subscription
        subscribe(DiagnosticStatus, 'machine_state', self._on_machine_state, LATCHED)
        subscribe(DiagnosticStatus, 'motion_status', self._on_motion_status, LATCHED)
        subscribe(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)

    def __enter__(self) -> 'Client':
        """The client itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Leaves the graph."""
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
                raise TimedOut(f'waited {seconds:g} s in vain for {what} ({self.summary})')
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

    def enable(self) -> None:
        """Energises the servos and waits until the machine takes goals; Refused with the reason.

        However long the servos take: the patience begins again with each *arming* of the bridge.
        """
        self.wait(
            'the board', lambda: self.machine_state.message not in WITHOUT_BOARD, seconds=15.0
        )
        self._call(SetBool, 'serial_bridge/enable', SetBool.Request(data=True))
        before = self._states_received
        self.wait(
            'enabling',
            lambda: self.motion('mode') not in ('', MotionMode.DISABLED) or self._is_lost(before),
            DRIVEN_WITHIN,
            lambda: self.machine_state.message == MachineState.ARMING and self._states_received,
        )
        if self._is_lost(before):
            raise Refused(f'not enabled: {self.summary}')

    def _is_lost(self, before: int) -> bool:
        """Whether a state later than the `before`-th shows that the servos do not go on."""
        return self._states_received > before and self.machine_state.message not in ENABLING

    def disable(self) -> None:
        """Switches the servos off."""
        self._call(SetBool, 'serial_bridge/enable', SetBool.Request(data=False))

    def trigger(self, service: str) -> str:
        """Calls a Trigger service of the graph; Refused with its reason when it fails."""
        return self._call(Trigger, service, Trigger.Request())

    def publish_goal(self, pose: Pose) -> float:
        """Publishes a goal and returns its stamp, by which motion_status names it."""
        stamp = self.node.get_clock().now().to_msg()
        self._goals.publish(pose_message(pose, stamp))
        return seconds(stamp)

    def go_to(self, pose: Pose, seconds: float = 10.0) -> None:
        """Publishes a goal and waits until it is reached; Refused or Stopped with the reason.

        However long that takes: TimedOut after `seconds` in which nothing moves or is received.
        """
        self.wait('a subscriber on goal_pose', lambda: self._reaches(self._goals), 10.0)
        stamp = f'{self.publish_goal(pose):.9f}'
        self._await_result(lambda: self.motion('goal_stamp') == stamp, seconds)

    def follow(self, poses: Pose, seconds: float = 60.0) -> None:
        """Goes exactly along poses (n,), n ≤ 2,000; Refused or Stopped with the reason.

        `seconds` as for go_to: they must also do for working the path out.
        """
        self.wait('a subscriber on goal_path', lambda: self._reaches(self._paths), 10.0)
        stamp = self.node.get_clock().now().to_msg()
        self._paths.publish(path_message(poses, stamp))
        name = f'{stamp.sec + 1e-9 * stamp.nanosec:.9f}'
        self._await_result(lambda: self.motion('goal_stamp') == name, seconds)

    def home(self, seconds: float = 10.0) -> None:
        """Goes home and waits until it is there; Refused or Stopped with the reason.

        `seconds` as for go_to.
        """
        self._go('home', seconds)

    def park(self, seconds: float = 10.0) -> None:
        """Goes to the joints at which the servos are switched on and off; as `home`."""
        self._go('park', seconds)

    def _go(self, place: str, seconds: float) -> None:
        before = self.motion('goal_stamp')
        self.trigger(f'trajectory/{place}')
        self._await_result(lambda: self.motion('goal_stamp') != before, seconds)

    def _reaches(self, publisher: Any) -> bool:
        """Whether all who subscribe to it are connected, the trajectory node among them."""
        found = [
            one
            for one in self.node.get_subscriptions_info_by_topic(publisher.topic_name)
            if one.qos_profile.durability == DurabilityPolicy.VOLATILE
        ]
        is_there = any(one.node_name == 'trajectory' for one in found)
        return is_there and bool(publisher.get_subscription_count() >= len(found))

    def _await_result(self, is_ours: Callable[[], bool], seconds: float) -> None:
        ends: dict[str, type[ManipulatorError] | None] = {
            MotionResult.REACHED: None,
            MotionResult.REFUSED: Refused,
            MotionResult.STOPPED: Stopped,
        }
        if self._setpoints is None:
            self._setpoints = self.node.create_subscription(
                PoseStamped, 'setpoint', self._on_setpoint, COMMAND
            )
        self.wait(
            'reaching the goal',
            lambda: is_ours() and self.motion('result') in ends,
            seconds,
            lambda: (self.motion_status, self._commanded) if is_ours() else None,
        )
        error = ends[self.motion('result')]
        if error is not None:
            raise error(self.motion_status.message)

    def _call(self, kind: type, name: str, request: Any) -> str:
        client = self.node.create_client(kind, name)
        try:
            self.wait(f'service {name}', client.service_is_ready, seconds=10.0)
            response = self.answer_of(client, request, f'an answer of {name}')
        finally:
            self.node.destroy_client(client)
        if not response.success:
            raise Refused(f'{name}: {response.message}')
        return str(response.message)

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

    def _on_setpoint(self, message: PoseStamped) -> None:
        self._commanded = message.pose

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for entry in message.status:
            self.diagnostics[entry.name] = entry


WITHOUT_BOARD = (UNKNOWN, MachineState.DISCONNECTED, MachineState.BOOTING)
ENABLING = (MachineState.ARMING, MachineState.ENABLED, MachineState.HOLDING)
"""States of a machine that is being enabled, until it can take goals."""
