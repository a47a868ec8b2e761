"""Turning about a coordinate axis of the base or the tool, with the tool point fixed."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose
from manipulator.teleop.directions import turn_but_about
from manipulator.teleop.feedback import Feedback


@dataclass(frozen=True)
class TurnAboutAxis:
    """`axis` 0, 1, 2 is x, y, z of the named frame."""

    feedback: Feedback
    axis: Literal[0, 1, 2]
    frame: Literal['base', 'tool'] = 'base'

    def latched(self, pose: Pose) -> 'AxisHeld':
        """Holds the tool point, and the axis where it points now."""
        unit = np.eye(3)[self.axis]
        axis = unit if self.frame == 'base' else pose.rotation @ unit
        return AxisHeld(self.feedback, frozen(axis), pose)


@dataclass(frozen=True, eq=False)
class AxisHeld:
    """`axis` (3,) in base axes, `start` the pose when motion began.

    The angle about the axis is the operator's; the tool point and the other two directions are
    held. A tool axis is held as well as a base axis: turning about it leaves it where it is.
    """

    feedback: Feedback
    axis: Array
    start: Pose

    def step(self, command: Array, measured: Pose, commanded: Array) -> 'tuple[Array, AxisHeld]':
        """The command's turn about the axis, and the way back to the point and the axis."""
        swing = turn_but_about(self.axis, self.start.rotation @ measured.rotation.T)
        turn = (command[3:] @ self.axis) * self.axis + self.feedback.angular(swing)
        shift = self.feedback.linear(self.start.position - measured.position)
        return np.concatenate([shift, turn]), self
