"""Jogging with the tool pointing at one point in space, and orbiting it."""

from dataclasses import dataclass, replace

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import Refused
from manipulator.pose import Pose
from manipulator.teleop.directions import turn_between
from manipulator.teleop.feedback import Feedback
from manipulator.teleop.parallel_to_axis import TOOL_AXIS

NEAREST = 0.02
"""Metres: nearer to the point, no direction to it is worth following."""
STILL = 1e-6
"""m/s below which the operator does not translate."""


@dataclass(frozen=True, eq=False)
class LookAt:
    """`point` (3,) in the base frame."""

    feedback: Feedback
    point: Array

    def latched(self, pose: Pose) -> 'PointHeld':
        """Raises Refused when the tool stands on the point."""
        distance = float(np.linalg.norm(self.point - pose.position))
        if distance < NEAREST:
            raise Refused(
                f'look-at point is {distance:.4g} m from the tool, needs at least {NEAREST} m'
            )
        return PointHeld(self.feedback, frozen(self.point), distance)


@dataclass(frozen=True, eq=False)
class PointHeld:
    """`distance` (metres) from tool to point is held while the operator does not translate."""

    feedback: Feedback
    point: Array
    distance: float

    def step(self, command: Array, measured: Pose, commanded: Array) -> 'tuple[Array, PointHeld]':
        """Translation as commanded; turns about the line of sight roll, all others orbit.

        With d the unit vector to the point, r away from the commanded position, the tool follows
        ω = −d × v / r. The whole velocity is scaled so that it comes no nearer than NEAREST.
        """
        seen, d_seen = _sight(self.point - measured.position)
        ahead, d = _sight(self.point - commanded)
        roll = (command[3:] @ d) * d
        velocity = command[:3] + np.cross(command[3:] - roll, -ahead * d)
        distance = self.distance
        if np.linalg.norm(command[:3]) > STILL:
            distance = ahead
        else:
            velocity = velocity + self.feedback.linear((seen - distance) * d)
        velocity = velocity * self._approach(float(velocity @ d), ahead)
        aim_error = turn_between(measured.rotation @ np.array(TOOL_AXIS), d_seen)
        follow = -np.cross(d, velocity) / max(ahead, NEAREST)
        twist = np.concatenate([velocity, roll + follow + self.feedback.angular(aim_error)])
        return twist, replace(self, distance=distance)

    def _approach(self, speed: float, distance: float) -> float:
        """The part of the velocity that the way left allows."""
        allowed = self.feedback.gain * max(distance - NEAREST, 0.0)
        return 1.0 if speed <= allowed else allowed / speed


def _sight(arm: Array) -> tuple[float, Array]:
    """Distance and direction of the point."""
    distance = max(float(np.linalg.norm(arm)), 1e-9)
    return distance, arm / distance
