"""A client of one machine's graph: enables it, sends goals, receives their results."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from rclpy.qos import DurabilityPolicy

from hexarm.graph_client import GraphClient
from manipulator.errors import ManipulatorError, Refused, Stopped
from manipulator.nodes.messages import BASE_FRAME, pose_message, seconds
from manipulator.nodes.path_goals import path_message
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.trajectory_services import STAMP
from manipulator.pose import Pose
from manipulator.states import UNKNOWN, MachineState, MotionMode, MotionResult

DRIVEN_WITHIN = 15.0
"""Seconds until a machine whose servos are on takes goals: its nodes may still be starting."""

ENDS: dict[str, type[ManipulatorError]] = {
    MotionResult.REFUSED: Refused,
    MotionResult.STOPPED: Stopped,
}
"""What is raised for a goal that is not reached."""

FOLLOWED = (MotionResult.MOVING, MotionResult.REACHED, MotionResult.STOPPED)
"""Results of another goal that has taken the place of ours."""


@dataclass
class Pursued:
    """A goal of this client, and what motion_status has reported of it by now."""

    stamp: str
    result: str = ''
    text: str = ''

    def note(self, status: DiagnosticStatus) -> None:
        """Takes up a status of this goal, and one that shows that another took its place."""
        values = {pair.key: pair.value for pair in status.values}
        stamp, result = values.get('goal_stamp', ''), values.get('result', '')
        if self.result in ENDS or self.result == MotionResult.REACHED:
            return
        if stamp == self.stamp:
            self.result, self.text = result, values.get('reason') or status.message
        elif self.result and result in FOLLOWED:
            self.result, self.text = MotionResult.STOPPED, 'another goal took its place'


class Client(GraphClient):
    """Enables the machine and sends goals, one at a time; see GraphClient."""

    def __init__(self, namespace: str, interrupt: Callable[[], None] = lambda: None) -> None:
        super().__init__(namespace, interrupt)
        self.setpoint: Any = None
        self._setpoints: Any = None
        self._pursued = Pursued('')
        self._goals = self.node.create_publisher(PoseStamped, 'goal_pose', COMMAND)
        self._paths = self.node.create_publisher(Path, 'goal_path', COMMAND)

    def enable(self, report: Callable[[str], object] = lambda words: None) -> None:
        """Energises the servos and waits until the machine takes goals; Refused with the reason.

        report is given the bridge's answer: what the servos do meanwhile. However long they
        take: the patience begins again with each *arming* of the bridge.
        """
        self.wait(
            'the board or driver',
            lambda: self.machine_state.message not in WITHOUT_BOARD,
            seconds=15.0,
        )
        report(self.switch('serial_bridge/enable', True))
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
        self.switch('serial_bridge/enable', False)

    def publish_goal(self, pose: Pose, frame: str = BASE_FRAME) -> float:
        """Publishes a goal and returns its stamp, by which motion_status names it."""
        stamp = self.node.get_clock().now().to_msg()
        self._goals.publish(pose_message(pose, stamp, frame))
        return seconds(stamp)

    def send_goal(self, pose: Pose, frame: str = BASE_FRAME) -> None:
        """Publishes a goal, once the machine can receive it; `is_there` reports its result."""
        self.wait('a subscriber on goal_pose', lambda: self.reaches(self._goals), 10.0)
        self._pursue(f'{self.publish_goal(pose, frame):.9f}')

    def send_path(self, poses: Pose, times: Sequence[float] | None = None) -> None:
        """As send_goal, a path of poses (n,), n ≤ 2,000; `times` (s) at which to pass them."""
        self.wait('a subscriber on goal_path', lambda: self.reaches(self._paths), 10.0)
        stamp = self.node.get_clock().now().to_msg()
        stamps = None if times is None else [time_message(t) for t in times]
        self._paths.publish(path_message(poses, stamp, stamps=stamps))
        self._pursue(f'{seconds(stamp):.9f}')

    def send_to(self, place: str) -> None:
        """As send_goal, to 'home' or 'park'; Refused with the reason."""
        self._pursue(self.trigger(f'trajectory/{place}').rpartition(STAMP)[2])

    def is_there(self) -> bool:
        """Whether the newest own goal is reached; Refused or Stopped where it never will be."""
        error = ENDS.get(self._pursued.result)
        if error is not None:
            raise error(self._pursued.text)
        return self._pursued.result == MotionResult.REACHED

    def is_known(self) -> bool:
        """Whether the machine has reported anything of the newest own goal."""
        return bool(self._pursued.result)

    def await_goal(self, seconds: float, report: Callable[[], object] = lambda: None) -> None:
        """Waits until the newest own goal is reached; Refused or Stopped with the reason.

        However long that takes: TimedOut after `seconds` in which nothing moves or is received.
        `report` is called again and again until it is reached.
        """

        def progress() -> object:
            report()
            return (self.motion_status, self.setpoint) if self.is_known() else None

        self.wait('reaching the goal', self.is_there, seconds, progress)

    def go_to(self, pose: Pose, seconds: float = 10.0) -> None:
        """Publishes a goal and waits until it is reached, as await_goal."""
        self.send_goal(pose)
        self.await_goal(seconds)

    def follow(self, poses: Pose, seconds: float = 60.0) -> None:
        """Goes exactly along poses (n,), n ≤ 2,000; the seconds must also do for its planning."""
        self.send_path(poses)
        self.await_goal(seconds)

    def home(self, seconds: float = 10.0) -> None:
        """Goes home and waits until it is there, as await_goal."""
        self.send_to('home')
        self.await_goal(seconds)

    def park(self, seconds: float = 10.0) -> None:
        """Goes to the joints at which the servos are switched on and off, as await_goal."""
        self.send_to('park')
        self.await_goal(seconds)

    def watch_setpoints(self) -> None:
        """Receives setpoints from now on: while they change, the machine moves."""
        if self._setpoints is None:
            self._setpoints = self.node.create_subscription(
                PoseStamped, 'setpoint', self._on_setpoint, COMMAND
            )

    def _pursue(self, stamp: str) -> None:
        self.watch_setpoints()
        self._pursued = Pursued(stamp)
        self._pursued.note(self.motion_status)

    def reaches(self, publisher: Any) -> bool:
        """Whether all who subscribe to it are connected, the trajectory node among them.

        It is known by the process that publishes motion_status, not by its name: that is not
        told again where the two lost each other for a while (DDS's lease of 20 s).
        """
        info = self.node.get_subscriptions_info_by_topic(publisher.topic_name)
        found = [one for one in info if one.qos_profile.durability == DurabilityPolicy.VOLATILE]
        status = self.node.resolve_topic_name('motion_status')
        there = {_participant(one) for one in self.node.get_publishers_info_by_topic(status)}
        is_there = any(_participant(one) in there for one in found)
        return is_there and bool(publisher.get_subscription_count() >= len(found))

    def _on_motion_status(self, message: DiagnosticStatus) -> None:
        self.motion_status = message
        self._pursued.note(message)

    def _on_setpoint(self, message: PoseStamped) -> None:
        self.setpoint = message.pose


def _participant(endpoint: Any) -> tuple[int, ...]:
    """The first 12 bytes of a DDS identifier: the process, or the context, that it is part of."""
    return tuple(endpoint.endpoint_gid[:12])


def time_message(seconds: float) -> Time:
    """Seconds as a stamp."""
    whole, rest = divmod(round(1e9 * seconds), 10**9)
    return Time(sec=whole, nanosec=rest)


WITHOUT_BOARD = (UNKNOWN, MachineState.DISCONNECTED, MachineState.BOOTING)
ENABLING = (MachineState.ARMING, MachineState.ENABLED, MachineState.HOLDING)
"""States of a machine that is being enabled, until it can take goals."""
