"""From setpoints to joint commands: checks and refuses, never bends, never retimes."""

from collections.abc import Callable

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from manipulator.arrays import Array
from manipulator.errors import LimitViolated
from manipulator.machine import Machine
from manipulator.nodes.diagnostics import Diagnostics, Report
from manipulator.nodes.intake import Intake
from manipulator.nodes.messages import joint_message, joints_of, pose_of
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, MEASUREMENT
from manipulator.pose import Pose

FORGET_AFTER = 0.25
"""Seconds after which the last command no longer says where the joints are."""

SHORTEST_STEP, LONGEST_STEP = 0.02, 0.1
"""A joint may step as far as its speed allows within this time (messages may bunch up)."""


class IkNode(Node):
    """setpoint and joint_states in, joint_command out; see docs/interfaces.md."""

    def __init__(self, load: Callable[[str], Machine], default_machine: str) -> None:
        super().__init__('ik')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        self._machine = load(name)
        self._names = self._machine.kinematics.joint_names
        self._commanded: Array | None = None
        self._measured: Array | None = None
        self._setpoint = Intake(self, 'setpoint', self._on_setpoint)
        self._states = Intake(self, 'joint_states', self._on_joint_states)
        self._publisher = self.create_publisher(JointState, 'joint_command', COMMAND)
        self.create_subscription(PoseStamped, 'setpoint', self._setpoint, COMMAND)
        self.create_subscription(JointState, 'joint_states', self._states, MEASUREMENT)
        self._diagnostics = Diagnostics(
            self, self._report, ('setpoint', 'joint_command', 'joint_states')
        )

    def _on_setpoint(self, message: PoseStamped) -> None:
        pose = pose_of(message)
        age = self._setpoint.age
        is_fresh = self._commanded is not None and age < FORGET_AFTER
        near = self._commanded if is_fresh else self._measured
        joints = self._machine.kinematics.inverse(pose, near)
        self._check_limits(pose, joints, near)
        if near is not None:
            self._check_step(joints, near, age if is_fresh else LONGEST_STEP)
        self._commanded = joints
        self._publisher.publish(joint_message(joints, self._names, message.header.stamp))

    def _on_joint_states(self, message: JointState) -> None:
        if set(self._names) <= set(message.name):
            self._measured = joints_of(message, self._names)
        else:
            self._measured = self._commanded = None

    def _check_limits(self, pose: Pose, joints: Array, near: Array | None) -> None:
        """From beyond a limit, only the way back is allowed."""
        constraints = self._machine.constraints
        if near is not None and not constraints.admits(pose, joints):
            start = self._machine.kinematics.forward(near, pose).pose
            constraints = constraints.stretched_to(start, near)
        constraints.check(pose, joints)

    def _check_step(self, joints: Array, near: Array, age: float) -> None:
        """Refuses a jump away from the last command, unless it leads to where the joints are."""
        time = min(max(age, SHORTEST_STEP), LONGEST_STEP)
        bounds = np.broadcast_to(self._machine.motion.joint.speed * time, joints.shape)
        steps = np.abs(joints - near)
        worst = int(np.argmax(steps / bounds))
        allowed = float(bounds[worst])
        if steps[worst] <= allowed or self._is_present(joints, bounds):
            return
        unit = self._machine.kinematics.joint_unit
        raise LimitViolated(
            f'{self._names[worst]} would jump by {steps[worst]:.4g} {unit}, at most '
            f'{allowed:.4g} {unit} in {time:.3g} s: begin at the present pose',
            'joint step',
            float(steps[worst]),
            (0.0, allowed),
            worst + 1,
        )

    def _is_present(self, joints: Array, tolerance: Array) -> bool:
        return self._measured is not None and bool(
            (np.abs(joints - self._measured) <= tolerance).all()
        )

    def _report(self) -> Report:
        values = {
            'last_setpoint_age_s': self._setpoint.age,
            'setpoints_refused': self._setpoint.refused,
            'last_refusal': self._setpoint.last_refusal,
        }
        if self._setpoint.age > 1.0:
            return DiagnosticStatus.OK, 'no setpoints', values
        return DiagnosticStatus.OK, 'running', values
