"""`goal_joints` and `joint_trajectory`: bounded in length before they are decoded."""

import time
from collections.abc import Callable
from functools import partial

from builtin_interfaces.msg import Time
from rclpy.node import Node
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError, Refused
from manipulator.nodes.messages import joint_points_of, named_joints, seconds
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.subscriptions import FilteredCallback, RawMessage, decoded, raw_message
from manipulator.planning.joint_points import MOST_POINTS, JointPoints
from manipulator.trajectory.controller import MotionController
from manipulator.trajectory.path_planning import TrajectoryGoal

MOST_NAMED_BYTES = 10_000
"""Of a serialized JointState: as for joint_command."""

MOST_BYTES = 250 * MOST_POINTS
"""Of a serialized trajectory: a point of six joints takes 172 bytes without effort."""

MOST_AHEAD = 60.0
"""Seconds from now at which a trajectory may begin."""


class JointTopics:
    """The topics; trajectories of the action are begun here, too."""

    def __init__(self, node: Node, controller: MotionController, tolerance: Array) -> None:
        """Tolerance (n,): how far a trajectory's first point may be from where the machine is."""
        self._node, self._controller, self._tolerance = node, controller, tolerance
        self.names = controller.supervisor.machine.kinematics.joint_names
        self._goals = FilteredCallback(node, 'goal_joints', self._on_goal, self._on_bad_goal)
        subscribe = partial(node.create_subscription, qos_profile=COMMAND, raw=True)
        subscribe(
            JointState, 'goal_joints', lambda raw: self._goals(raw_message(raw, MOST_NAMED_BYTES))
        )
        subscribe(JointTrajectory, 'joint_trajectory', self._on_trajectory)

    def name_of(self, start: Time) -> float:
        """The stamp by which motion_status knows a trajectory: its own, or that of its receipt."""
        return seconds(start) or self._now()

    def _on_goal(self, message: RawMessage) -> None:
        goal = decoded(message.serialized, JointState, MOST_NAMED_BYTES)
        self._controller.move_joints(
            named_joints(goal, 'position'),
            seconds(message.header.stamp),
            lambda error: self._goals.refuse(message, error),
            time.monotonic(),
        )

    def _on_bad_goal(self, message: RawMessage, error: ManipulatorError) -> None:
        self._controller.refuse(seconds(message.header.stamp), error)

    def _on_trajectory(self, serialized: bytes) -> None:
        start = raw_message(serialized, MOST_BYTES).header.stamp
        stamp = self.name_of(start)
        try:
            if len(serialized) > MOST_BYTES:
                raise InvalidInput(
                    f'a trajectory of {len(serialized):,} bytes, limit {MOST_BYTES:,}: '
                    f'{MOST_POINTS:,} points take less'
                )
            self.begin(start, partial(_read, serialized, self.names), stamp)
        except ManipulatorError as error:
            self._refuse(stamp, error)

    def begin(self, start: Time, read: Callable[[], JointPoints], stamp: float) -> None:
        """A trajectory named `stamp`; raises ManipulatorError, or refuses it later."""
        now, starts_at = time.monotonic(), None
        if seconds(start):
            ahead = seconds(start) - self._now()
            if ahead > MOST_AHEAD:
                raise Refused(
                    f'the trajectory begins in {ahead:.3g} s, at most {MOST_AHEAD:g} s: '
                    'is the clock of its sender right?'
                )
            starts_at = now + ahead
        goal = TrajectoryGoal(stamp, read, self._tolerance, starts_at)
        self._controller.follow_joints(goal, partial(self._refuse, stamp), now)

    def _refuse(self, stamp: float, error: ManipulatorError) -> None:
        text = f'joint_trajectory: {error}'
        self._node.get_logger().warning(text, throttle_duration_sec=1.0)
        self._controller.refuse(stamp, error)

    def _now(self) -> float:
        return seconds(self._node.get_clock().now().to_msg())


def _read(serialized: bytes, names: tuple[str, ...]) -> JointPoints:
    return joint_points_of(decoded(serialized, JointTrajectory, MOST_BYTES), names)
