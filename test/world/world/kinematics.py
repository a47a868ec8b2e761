"""What the ik and pose nodes do, without ROS."""

from manipulator.command_check import CommandCheck
from manipulator.errors import NoSolution
from manipulator.sag import commanded, settled
from world.intake import Intake
from world.timeline import Process


class Inverse(Process):
    """Setpoints and joints in, joint commands out (manipulator/nodes/ik_node.py).

    published: (time, joints); what it refused stands in `on_setpoint.refusals`.
    """

    def __init__(self, timeline, machine, commands):
        super().__init__(timeline)
        self._machine, self._commands = machine, commands
        self.check = CommandCheck(machine)
        self.published = []
        self.on_setpoint = Intake(self, self._take)
        self.on_joints = Intake(self, lambda stamp, joints: self.check.note_joints(joints))

    def _take(self, stamp, pose):
        joints = commanded(self._machine.sag, pose, self.check.admit(pose, self.now))
        self.published.append((self.now, joints))
        self._commands.send(stamp, joints)


class Forward(Process):
    """Joints in, the platform's pose out (manipulator/nodes/pose_node.py)."""

    def __init__(self, timeline, machine, poses):
        super().__init__(timeline)
        self._machine, self._poses = machine, poses
        self._solution = None
        self.on_joints = Intake(self, self._take)

    def _take(self, stamp, joints):
        near, self._solution = self._solution, None
        if joints is None:
            return
        kinematics = self._machine.kinematics
        if near is not None:
            try:
                self._solution = kinematics.forward(joints, near.pose)
            except NoSolution:
                near = None
        if near is None:
            self._solution = self._cold(joints)
        self._solution = settled(self._machine.sag, kinematics, joints, self._solution)
        self._poses.send(stamp, self._solution.pose)

    def _cold(self, joints):
        solution = self._machine.kinematics.forward(joints)
        if solution.iterations > 0:
            self._machine.constraints.check(solution.pose, joints)
        return solution
