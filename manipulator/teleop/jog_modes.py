"""What a jog mode is, and the modes that hold an orientation or a point.

A mode latches a reference when motion begins and closes a loop on it; the plain jog holds nothing.
"""

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.pose import Pose


def turn_between(direction: Array, target: Array) -> Array:
    """The shortest rotation vector (3,) that turns one unit vector into the other.

    For opposite vectors, half a turn about some axis at a right angle to them.
    """
    axis = np.cross(direction, target)
    sine, cosine = float(np.linalg.norm(axis)), float(direction @ target)
    if sine > 1e-9:
        result: Array = axis * (np.arctan2(sine, cosine) / sine)
        return result
    if cosine > 0:
        return np.zeros(3)
    across = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    half_turn: Array = np.pi * across / np.linalg.norm(across)
    return half_turn


def turn_but_about(axis: Array, rotation: Array) -> Array:
    """The rotation vector of `rotation` without its part about the unit `axis`.

    It is the shortest among those of Rot(axis, θ)·rotation for all θ, at a right angle to `axis`
    (swing-twist decomposition of the unit quaternion).
    """
    quaternion = so3.to_quaternion(rotation)
    angle = 2.0 * np.arctan2(quaternion[:3] @ axis, quaternion[3])
    result: Array = so3.log(so3.exp(-angle * axis) @ rotation)
    return result


GAIN_TIMES_DELAY = 0.3
"""K·delay of a loop that neither rings nor diverges: it is critically damped at 1/e = 0.37."""
MAX_GAIN = 10.0
"""1/s, however short the delay."""


@dataclass(frozen=True)
class Feedback:
    """velocity = gain · error, bounded: gain in 1/s, the bounds in m/s and rad/s.

    The bounds let a mode that begins far from its reference approach it gently.
    """

    gain: float
    linear_bound: float = 0.05
    angular_bound: float = 0.5

    def __post_init__(self) -> None:
        """Raises InvalidInput for gains and bounds that are not positive."""
        for name in ('gain', 'linear_bound', 'angular_bound'):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InvalidInput(f'{name} is {value}, needs a positive number')

    @classmethod
    def for_delay(cls, delay: float) -> 'Feedback':
        """With the gain that a delay of so many seconds, measurement to motion, allows.

        Raises InvalidInput for a delay that is negative or not finite.
        """
        if not 0 <= delay < math.inf:
            raise InvalidInput(f'delay is {delay} s, needs a number from 0 up')
        return cls(min(MAX_GAIN, GAIN_TIMES_DELAY / max(delay, 1e-9)))

    def linear(self, error: Array) -> Array:
        """Velocity (3,) in m/s towards a point that is `error` metres away."""
        return _bounded(self.gain * error, self.linear_bound)

    def angular(self, error: Array) -> Array:
        """Angular velocity (3,) in rad/s towards an orientation, `error` a rotation vector."""
        return _bounded(self.gain * error, self.angular_bound)


def _bounded(velocity: Array, bound: float) -> Array:
    speed = math.hypot(*velocity.tolist())
    return velocity if speed <= bound else velocity * (bound / speed)


class Held(Protocol):
    """A mode in motion, with its reference. A value: `step` returns its successor.

    Twists are (6,), of the tool in base axes, in m/s and rad/s.
    """

    def step(self, command: Array, measured: Pose, commanded: Array) -> 'tuple[Array, Held]':
        """The twist to drive for the operator's command, and the mode for the next tick.

        What was held is compared with the measured pose, which may be late by the delay for which
        the mode's feedback was chosen. What is known beforehand is reckoned from `commanded`
        (3,), where the tool's position is commanded to be midway through the coming tick.
        """
        ...


class JogMode(Protocol):
    """A mode at rest."""

    def latched(self, pose: Pose) -> Held:
        """The mode in motion, its reference taken from the pose at which motion begins.

        Raises Refused where the mode has no meaning.
        """
        ...


@dataclass(frozen=True)
class Free:
    """At rest and in motion alike."""

    def latched(self, pose: Pose) -> 'Free':
        """Needs no reference."""
        return self

    def step(self, command: Array, measured: Pose, commanded: Array) -> 'tuple[Array, Free]':
        """The command itself."""
        return command, self


@dataclass(frozen=True)
class HoldOrientation:
    """The orientation at the beginning of the motion is kept."""

    feedback: Feedback

    def latched(self, pose: Pose) -> 'OrientationHeld':
        """Holds the pose's orientation."""
        return OrientationHeld(self.feedback, pose)


@dataclass(frozen=True, eq=False)
class OrientationHeld:
    """`start` is the pose when motion began."""

    feedback: Feedback
    start: Pose

    def step(
        self, command: Array, measured: Pose, commanded: Array
    ) -> 'tuple[Array, OrientationHeld]':
        """The command's velocity and the turn back to the orientation; its own turn is lost."""
        twist = command.copy()
        twist[3:] = self.feedback.angular(measured.twist_to(self.start)[3:])
        return twist, self


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
