"""The topics of jogging: twists and joint rates of each source, the mode, the point to look at."""

import time

import numpy as np
from geometry_msgs.msg import PointStamped, TwistStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from manipulator.errors import ManipulatorError
from manipulator.nodes.joint_topics import MOST_NAMED_BYTES
from manipulator.nodes.messages import (
    BASE_FRAME,
    WORK_FRAME,
    named_joints,
    point_of,
    twist_of,
)
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.subscriptions import (
    FilteredCallback,
    RawMessage,
    SoleSubscription,
    decoded,
    raw_message,
)
from manipulator.teleop.arbiter import SOURCES
from manipulator.trajectory.teleop import Teleop


class TeleopTopics:
    """cmd_vel and cmd_joints of every source, jog_mode and look_at; see docs/teleop.md."""

    def __init__(self, node: Node, teleop: Teleop) -> None:
        self._node = node
        self._teleop = teleop
        self._callbacks: list[FilteredCallback] = []
        self._sources = [self._subscribe(source) for source in SOURCES]
        self._sources += [self._subscribe_joints(source) for source in SOURCES]
        node.create_subscription(String, 'jog_mode', self._on_mode, COMMAND)
        node.create_subscription(PointStamped, 'look_at', self._on_look_at, COMMAND)

    @property
    def conflict(self) -> str:
        """Which sources are refused because two publishers send on them, '' where none is."""
        return '; '.join(source.conflict for source in self._sources if source.conflict)

    def report(self) -> dict[str, object]:
        """The values of /diagnostics about jogging."""
        newest = max(self._callbacks, key=lambda callback: callback.refused_at)
        return {
            'jogged_by': self._teleop.owner(time.monotonic()),
            'jog_mode': self._teleop.mode,
            'twists_refused': sum(callback.refused for callback in self._callbacks),
            'last_twist_refusal': newest.last_refusal,
        }

    def _subscribe(self, source: str) -> SoleSubscription:
        def accept(message: TwistStamped) -> None:
            now = time.monotonic()
            if sole.conflict:
                self._teleop.reject(source, now, sole.conflict)
            self._teleop.receive(source, twist_of(message), message.header.frame_id, now)

        callback = FilteredCallback(self._node, source, accept)
        self._callbacks.append(callback)
        sole = SoleSubscription(self._node, TwistStamped, source, callback, COMMAND)
        return sole

    def _subscribe_joints(self, source: str) -> SoleSubscription:
        """Rates of joints: the same source as that of the twists, with the same deadman."""
        topic = source.replace('cmd_vel', 'cmd_joints')

        def accept(message: RawMessage) -> None:
            now = time.monotonic()
            if sole.conflict:
                self._teleop.reject(source, now, sole.conflict)
            rates = decoded(message.serialized, JointState, MOST_NAMED_BYTES)
            self._teleop.receive_joints(source, named_joints(rates, 'velocity'), now)

        callback = FilteredCallback(self._node, topic, accept)
        self._callbacks.append(callback)
        sole = SoleSubscription(
            self._node,
            JointState,
            topic,
            lambda raw: callback(raw_message(raw, MOST_NAMED_BYTES)),
            COMMAND,
            is_raw=True,
        )
        return sole

    def _on_mode(self, message: String) -> None:
        try:
            self._teleop.set_mode(message.data)
        except ManipulatorError as error:
            self._warn(f'jog_mode: {error}')

    def _on_look_at(self, message: PointStamped) -> None:
        try:
            point = np.array(point_of(message, BASE_FRAME, WORK_FRAME))
            is_in_work = message.header.frame_id == WORK_FRAME
            self._teleop.look_at(point, is_in_work)
        except ManipulatorError as error:
            self._warn(f'look_at: {error}')

    def _warn(self, text: str) -> None:
        self._node.get_logger().warning(text, throttle_duration_sec=1.0)
