"""The panel's subscriptions to a machine, kept until the page shows them."""

import contextlib
import time
from dataclasses import dataclass
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PointStamped, PoseStamped
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from hexarm.panel.gripper import GripperJoint
from hexarm.panel.view import NodeReport, Stance, View
from manipulator.errors import ManipulatorError
from manipulator.frames import Frames
from manipulator.machine import Machine
from manipulator.nodes.messages import PLATFORM_FRAME, joints_of, point_of, pose_of
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from manipulator.saved_poses import SavedPoses
from manipulator.states import UNKNOWN

STREAMS = {
    'pose': MEASUREMENT,
    'joint_states': MEASUREMENT,
    'setpoint': COMMAND,
    'joint_command': COMMAND,
}
"""What is drawn, with the quality of service of each."""

FRESH = 0.5
"""Seconds after which a pose or joints no longer count as known."""


@dataclass
class _Newest:
    """The newest message of a topic, serialized: most are replaced before they are shown."""

    kind: type
    serialized: bytes = b''
    received_at: float = float('-inf')

    def receive(self, serialized: bytes) -> None:
        """Keeps a message."""
        self.serialized, self.received_at = serialized, time.monotonic()

    def message(self) -> Any | None:
        """Decoded, or None where it is old."""
        if time.monotonic() - self.received_at > FRESH:
            return None
        return deserialize_message(self.serialized, self.kind)


class MachineSubscriptions:
    """Subscriptions of the panel; messages are only kept, and decoded when the page is drawn."""

    def __init__(self, node: Node, machine: Machine, gripper: GripperJoint | None) -> None:
        self._node = node
        self._gripper = gripper
        self._kinematics = machine.kinematics
        self._frames: Frames = machine.frames
        self._streams = {
            name: _Newest(JointState if 'joint' in name else PoseStamped) for name in STREAMS
        }
        self._subscriptions: list[Any] = []
        self.machine_state = DiagnosticStatus(message=UNKNOWN)
        self.motion_status = DiagnosticStatus()
        self._saved = SavedPoses.none_of(machine)
        self._reports: dict[str, tuple[DiagnosticStatus, float]] = {}
        subscribe = node.create_subscription
        subscribe(PointStamped, 'pivot', self._on_pivot, COMMAND)
        subscribe(String, 'tool', self._on_tool, COMMAND)
        subscribe(DiagnosticStatus, 'machine_state', self._on_machine_state, LATCHED)
        subscribe(DiagnosticStatus, 'motion_status', self._on_motion_status, LATCHED)
        subscribe(String, 'saved_poses', self._on_saved_poses, LATCHED)
        subscribe(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)

    def watch(self, is_watched: bool) -> None:
        """Subscribes to the fast topics only while a page is open: they are most of the work."""
        if is_watched == bool(self._subscriptions):
            return
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = [
            self._node.create_subscription(
                newest.kind, name, newest.receive, STREAMS[name], raw=True
            )
            for name, newest in self._streams.items()
            if is_watched
        ]

    def view(self) -> View:
        """What is known now."""
        return View(
            measured=self._stance('pose', 'joint_states'),
            commanded=self._stance('setpoint', 'joint_command'),
            frames=self._frames,
            machine_state=self.machine_state.message,
            machine_reason=_value(self.machine_state, 'reason'),
            mode=_value(self.motion_status, 'mode'),
            motion=self.motion_status.message,
            nodes=self._node_reports(),
            saved=self._saved.poses,
        )

    def _stance(self, pose_topic: str, joint_topic: str) -> Stance | None:
        """From two topics; None where one is old, or not of this machine."""
        pose = self._streams[pose_topic].message()
        joints = self._streams[joint_topic].message()
        if pose is None or joints is None:
            return None
        try:
            found = joints_of(joints, self._kinematics.joint_names)
            return Stance(pose_of(pose), found, self._opening(joints))
        except ManipulatorError:
            return None

    def _opening(self, joints: JointState) -> float | None:
        """The gripper's, None where the machine has none or the message does not name it."""
        with contextlib.suppress(ManipulatorError):
            if self._gripper is not None:
                return self._gripper.opening(joints_of(joints, (self._gripper.name,))[0])
        return None

    def _node_reports(self) -> tuple[NodeReport, ...]:
        now = time.monotonic()
        return tuple(
            NodeReport(
                name.rpartition('/')[2],
                report.level[0],
                report.message,
                {pair.key: pair.value for pair in report.values},
                now - at,
            )
            for name, (report, at) in sorted(self._reports.items())
        )

    def _on_machine_state(self, message: DiagnosticStatus) -> None:
        self.machine_state = message

    def _on_motion_status(self, message: DiagnosticStatus) -> None:
        self.motion_status = message

    def _on_saved_poses(self, message: String) -> None:
        try:
            self._saved = self._saved.read(message.data)
        except ManipulatorError as error:
            self._node.get_logger().warning(f'saved_poses: {error}', throttle_duration_sec=1.0)

    def _on_pivot(self, message: PointStamped) -> None:
        try:
            self._frames = self._frames.with_pivot(point_of(message, PLATFORM_FRAME))
        except ManipulatorError as error:
            self._node.get_logger().warning(f'pivot: {error}', throttle_duration_sec=1.0)

    def _on_tool(self, message: String) -> None:
        try:
            self._frames = self._frames.with_tool(message.data)
        except ManipulatorError as error:
            self._node.get_logger().warning(f'tool: {error}', throttle_duration_sec=1.0)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        space = self._node.get_namespace().strip('/')
        for entry in message.status:
            if entry.name.rpartition('/')[0] == space:
                self._reports[entry.name] = entry, time.monotonic()


def _value(status: DiagnosticStatus, key: str) -> str:
    return next((str(pair.value) for pair in status.values if pair.key == key), '')
