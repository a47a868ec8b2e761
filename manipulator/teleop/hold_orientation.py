"""Jogging with the orientation held constant: the stick translates."""

from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.pose import Pose
from manipulator.teleop.feedback import Feedback


@dataclass(frozen=True)
class HoldOrientation:
    """The orientation at the beginning of the motion is kept."""

    feedback: Feedback

    def latched(self, pose: Pose) -> 'OrientationHeld':
        """Holds the pose's orientation."""
        return OrientationHeld(self.feedback, pose.rotation)


@dataclass(frozen=True, eq=False)
class OrientationHeld:
    """`rotation` is T_base_tool's when motion began."""

    feedback: Feedback
    rotation: Array

    def step(
        self, command: Array, measured: Pose, commanded: Array
    ) -> 'tuple[Array, OrientationHeld]':
        """The command's velocity and the turn back to the orientation; its own turn is lost."""
        error = so3.log(self.rotation @ measured.rotation.T)
        return np.concatenate([command[:3], self.feedback.angular(error)]), self
