"""The processes of inverse and forward kinematics."""

from manipulator.pose_estimate import PoseEstimate
from manipulator.setpoint_validator import SetpointValidator
from world.filtered_callback import FilteredCallback
from world.timeline import Process


class Inverse(Process):
    """Setpoints and joints in, joint commands out (manipulator/nodes/ik_node.py).

    published: (time, joints); what it refused stands in `on_setpoint.refusals`.
    """

    def __init__(self, timeline, machine, commands):
        super().__init__(timeline)
        self._commands = commands
        self.check = SetpointValidator(machine)
        self.published = []
        self.on_setpoint = FilteredCallback(self, self._take)
        self.on_joints = FilteredCallback(
            self, lambda stamp, joints: self.check.note_joints(joints)
        )

    def on_requested(self, joints):
        self.check.note_requested(joints, self.now)

    def _take(self, stamp, pose):
        joints = self.check.command(pose, self.now)
        self.published.append((self.now, joints))
        self._commands.send(stamp, joints)


class Forward(Process):
    """Joints in, the platform's pose out."""

    def __init__(self, timeline, machine, poses):
        super().__init__(timeline)
        self._poses = poses
        self.estimate = PoseEstimate(machine)
        self.on_joints = FilteredCallback(self, self._take)

    def _take(self, stamp, joints):
        solution = self.estimate.update(joints)
        if solution is not None:
            self._poses.send(stamp, solution.pose)
