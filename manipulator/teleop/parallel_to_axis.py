"""Jogging with the tool kept parallel to a coordinate axis of the base."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose
from manipulator.teleop.directions import turn_between
from manipulator.teleop.feedback import Feedback

TOOL_AXIS = (0.0, 0.0, 1.0)
"""The approach axis a, in tool axes."""


@dataclass(frozen=True)
class ParallelToAxis:
    """The tool's approach axis along ±x, ±y or ±z, whichever is nearest when motion begins."""

    feedback: Feedback

    def latched(self, pose: Pose) -> 'DirectionHeld':
        """Chooses the nearest of the six directions."""
        approach = pose.rotation @ np.array(TOOL_AXIS)
        nearest = int(np.argmax(np.abs(approach)))
        direction = np.eye(3)[nearest] * np.sign(approach[nearest])
        return DirectionHeld(self.feedback, frozen(direction))


@dataclass(frozen=True, eq=False)
class DirectionHeld:
    """`direction` (3,), a unit vector in base axes."""

    feedback: Feedback
    direction: Array

    def step(
        self, command: Array, measured: Pose, commanded: Array
    ) -> 'tuple[Array, DirectionHeld]':
        """The command's velocity and its turn about the direction; other turns are the loop's."""
        approach = measured.rotation @ np.array(TOOL_AXIS)
        back = self.feedback.angular(turn_between(approach, self.direction))
        turn = (command[3:] @ self.direction) * self.direction + back
        return np.concatenate([command[:3], turn]), self
