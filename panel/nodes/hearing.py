"""What the panel's node hears of a machine, kept until the page shows it."""

import time
from dataclasses import dataclass

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PointStamped, PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from manipulator.errors import ManipulatorError
from manipulator.frames import Frames
from manipulator.kinematics import Kinematics
from manipulator.machine import Machine
from manipulator.nodes.messages import PLATFORM_FRAME, joints_of, point_of, pose_of
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from panel.view import NodeReport, Stance, View

FRESH = 0.5
"""Seconds after which a pose or joints no longer count as known."""


@dataclass
class _Pair:
    """The last pose and joints of one origin, as messages, and when they came."""

    pose: PoseStamped | None = None
    joints: JointState | None = None
    pose_at: float = float('-inf')
    joints_at: float = float('-inf')

    def hear_pose(self, message: PoseStamped) -> None:
        """Keeps a pose."""
        self.pose, self.pose_at = message, time.monotonic()

    def hear_joints(self, message: JointState) -> None:
        """Keeps joints."""
        self.joints, self.joints_at = message, time.monotonic()

    def stance(self, kinematics: Kinematics) -> Stance | None:
        """Both, decoded; None where one is missing, old or no pose of this machine."""
        if time.monotonic() - min(self.pose_at, self.joints_at) > FRESH:
            return None
        try:
            return Stance(pose_of(self.pose), joints_of(self.joints, kinematics.joint_names))
        except ManipulatorError:
            return None


class Hearing:
    """Subscriptions of the panel; messages are only kept, and decoded when the page is drawn."""

    def __init__(self, node: Node, machine: Machine) -> None:
        self._node = node
        self._kinematics = machine.kinematics
        self._frames: Frames = machine.frames
        self._measured, self._commanded = _Pair(), _Pair()
        self.machine_state = DiagnosticStatus(message='not heard of')
        self.motion_status = DiagnosticStatus()
        self._reports: dict[str, tuple[DiagnosticStatus, float]] = {}
        subscribe = node.create_subscription
        subscribe(PoseStamped, 'pose', self._measured.hear_pose, MEASUREMENT)
        subscribe(JointState, 'joint_states', self._measured.hear_joints, MEASUREMENT)
        subscribe(PoseStamped, 'setpoint', self._commanded.hear_pose, COMMAND)
        subscribe(JointState, 'joint_command', self._commanded.hear_joints, COMMAND)
        subscribe(PointStamped, 'pivot', self._on_pivot, COMMAND)
        subscribe(DiagnosticStatus, 'machine_state', self._on_machine_state, LATCHED)
        subscribe(DiagnosticStatus, 'motion_status', self._on_motion_status, LATCHED)
        subscribe(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)

    def view(self) -> View:
        """What is known now."""
        return View(
            measured=self._measured.stance(self._kinematics),
            commanded=self._commanded.stance(self._kinematics),
            frames=self._frames,
            machine_state=self.machine_state.message,
            machine_reason=_value(self.machine_state, 'reason'),
            mode=_value(self.motion_status, 'mode'),
            motion=self.motion_status.message,
            nodes=self._node_reports(),
        )

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

    def _on_pivot(self, message: PointStamped) -> None:
        try:
            self._frames = self._frames.with_pivot(point_of(message, PLATFORM_FRAME))
        except ManipulatorError as error:
            self._node.get_logger().warning(f'pivot: {error}', throttle_duration_sec=1.0)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        space = self._node.get_namespace().strip('/')
        for entry in message.status:
            if entry.name.rpartition('/')[0] == space:
                self._reports[entry.name] = entry, time.monotonic()


def _value(status: DiagnosticStatus, key: str) -> str:
    return next((str(pair.value) for pair in status.values if pair.key == key), '')
