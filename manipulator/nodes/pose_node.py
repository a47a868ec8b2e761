"""From joint states to the pose of the platform or tool, by forward kinematics."""

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PointStamped, PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.intake import Intake
from manipulator.nodes.markers import Markers
from manipulator.nodes.messages import (
    PLATFORM_FRAME,
    WORK_FRAME,
    known_joints,
    point_of,
    pose_message,
)
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, MEASUREMENT
from manipulator.nodes.transforms import Transforms, declare_prefix
from manipulator.pose_estimate import PoseEstimate


class PoseNode(Node):
    """joint_states in, pose out while all joints are known; see docs/interfaces.md."""

    def __init__(self, load: Callable[[str], Machine], default_machine: str) -> None:
        super().__init__('pose')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        machine = load(name)
        self._kinematics, self._frames = machine.kinematics, machine.frames
        self._estimate = PoseEstimate(machine, self.get_logger().info)
        self._states = Intake(self, 'joint_states', self._on_joint_states)
        self._publisher = self.create_publisher(PoseStamped, 'pose', MEASUREMENT)
        prefix = declare_prefix(self)
        self._markers = Markers(self, prefix)
        self._transforms = Transforms(self, prefix)
        self._pivot_publisher = self.create_publisher(PoseStamped, 'pivot_pose', MEASUREMENT)
        self.create_subscription(PointStamped, 'pivot', self._on_pivot, COMMAND)
        self.create_subscription(JointState, 'joint_states', self._states, MEASUREMENT)
        self._diagnostics = Diagnostics(self, self._report, ('joint_states', 'pose'))

    def _on_joint_states(self, message: JointState) -> None:
        joints = known_joints(message, self._kinematics.joint_names)
        solution = self._estimate.update(joints)
        if solution is None or joints is None:
            return
        pose, stamp = solution.pose, message.header.stamp
        self._publisher.publish(pose_message(pose, stamp))
        self._markers.show(self._kinematics, pose, joints, stamp)
        self._transforms.show(self._kinematics, self._frames, pose, joints, stamp)
        if self._pivot_publisher.get_subscription_count() > 0:
            in_work = pose_message(self._frames.pivot(pose), stamp, WORK_FRAME)
            self._pivot_publisher.publish(in_work)

    def _on_pivot(self, message: PointStamped) -> None:
        try:
            self._frames = self._frames.with_pivot(point_of(message, PLATFORM_FRAME))
        except InvalidInput as error:
            self.get_logger().warning(f'pivot: {error}', throttle_duration_sec=1.0)

    def _report(self) -> Report:
        values: dict[str, object] = {
            'last_joint_state_age_s': self._states.age,
            'joint_states_refused': self._states.refused,
            'last_refusal': self._states.last_refusal,
        }
        solution = self._estimate.solution
        if solution is None:
            return DiagnosticStatus.OK, 'no joint states', values
        values['singularity_margin'] = solution.sigma_min
        values['residual_mm'] = solution.residual * 1e3
        values['iterations'] = solution.iterations
        return DiagnosticStatus.OK, 'running', values
