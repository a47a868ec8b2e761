"""Jog modes by their names on the topic `jog_mode`; those that keep or point the tool.

The tool is kept parallel to a coordinate axis of the base, or points at one point in space.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import Refused
from manipulator.formatting import not_one_of
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import (
    Feedback,
    Free,
    HoldOrientation,
    JogMode,
    TurnAboutAxis,
    turn_between,
)

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
        """Raises Refused when the tool is at the point."""
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
        """The part of the velocity that the remaining distance allows."""
        allowed = self.feedback.gain * max(distance - NEAREST, 0.0)
        return 1.0 if speed <= allowed else allowed / speed


def _sight(arm: Array) -> tuple[float, Array]:
    """Distance and direction of the point."""
    distance = max(float(np.linalg.norm(arm)), 1e-9)
    return distance, arm / distance


def jog_mode(name: str, feedback: Feedback, point: Array | None = None) -> JogMode:
    """The mode of that name; `point` (3,) in the base frame is what look_at looks at.

    Raises Refused for an unknown name, with the nearest known one, and for look_at without point.
    """
    check_name(name)
    return MODES[name](feedback, point)


def check_name(name: str) -> None:
    """Raises Refused for an unknown name, with the nearest known one."""
    if name not in MODES:
        raise Refused(f'jog mode {not_one_of(name, MODES)}')


def _look_at(feedback: Feedback, point: Array | None) -> JogMode:
    if point is None:
        raise Refused('jog mode look_at: no point was given yet')
    return LookAt(feedback, point)


MODES: dict[str, Callable[[Feedback, Array | None], JogMode]] = {
    'free': lambda feedback, point: Free(),
    'hold_orientation': lambda feedback, point: HoldOrientation(feedback),
    'turn_base_x': lambda feedback, point: TurnAboutAxis(feedback, 0, 'base'),
    'turn_base_y': lambda feedback, point: TurnAboutAxis(feedback, 1, 'base'),
    'turn_base_z': lambda feedback, point: TurnAboutAxis(feedback, 2, 'base'),
    'turn_tool_x': lambda feedback, point: TurnAboutAxis(feedback, 0, 'tool'),
    'turn_tool_y': lambda feedback, point: TurnAboutAxis(feedback, 1, 'tool'),
    'turn_tool_z': lambda feedback, point: TurnAboutAxis(feedback, 2, 'tool'),
    'parallel': lambda feedback, point: ParallelToAxis(feedback),
    'look_at': _look_at,
}
