"""From setpoints to joint commands, checked by setpoint_validator.py."""

import time
from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from manipulator.machine import Machine
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.messages import joint_message, joints_of, known_joints, pose_of
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, MEASUREMENT
from manipulator.nodes.subscriptions import FilteredCallback
from manipulator.setpoint_validator import SetpointValidator


class IkNode(Node):
    """setpoint and joint_states in, joint_command out; see docs/interfaces.md."""

    def __init__(
        self, load: Callable[[str], Machine], default_machine: str, process: IntraProcess
    ) -> None:
        super().__init__('ik')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        machine = load(name)
        self._names = machine.kinematics.joint_names
        self._validator = SetpointValidator(machine)
        self._setpoint = FilteredCallback(self, 'setpoint', self._on_setpoint)
        self._states = FilteredCallback(self, 'joint_states', self._on_joint_states)
        self._requests = FilteredCallback(self, 'joint_setpoint', self._on_requested)
        self._publisher = process.publisher(self, JointState, 'joint_command', COMMAND)
        process.subscribe(self, PoseStamped, 'setpoint', self._setpoint, COMMAND)
        process.subscribe(self, JointState, 'joint_states', self._states, MEASUREMENT)
        process.subscribe(self, JointState, 'joint_setpoint', self._requests, COMMAND)
        self._diagnostics = Diagnostics(
            self, self._report, ('setpoint', 'joint_command', 'joint_states')
        )

    def _on_setpoint(self, message: PoseStamped) -> None:
        joints = self._validator.command(pose_of(message), time.monotonic())
        self._publisher.publish(joint_message(joints, self._names, message.header.stamp))

    def _on_requested(self, message: JointState) -> None:
        self._validator.note_requested(joints_of(message, self._names), time.monotonic())

    def _on_joint_states(self, message: JointState) -> None:
        self._validator.note_joints(known_joints(message, self._names))

    def _report(self) -> Report:
        values = {
            'last_setpoint_age_s': self._setpoint.age,
            'setpoints_refused': self._setpoint.refused,
            'last_refusal': self._setpoint.last_refusal,
        }
        if self._setpoint.age > 1.0:
            return DiagnosticStatus.OK, 'no setpoints', values
        return DiagnosticStatus.OK, 'running', values
