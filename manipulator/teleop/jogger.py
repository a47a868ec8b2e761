"""Following a twist, one tick after the other, within all limits of a machine.

A commanded twist is always that of the pivot; the frame of its axes can be chosen.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from operator import truediv
from typing import Protocol

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput, Refused
from manipulator.formatting import not_one_of
from manipulator.frames import Frames
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose

AXES: dict[str, Callable[[Frames, Pose], Array | None]] = {
    '': lambda frames, pose: None if frames.are_plain else frames.T_base_work.rotation.T,
    'base': lambda frames, pose: None if frames.are_plain else frames.T_base_work.rotation.T,
    'work': lambda frames, pose: None,
    'pivot': lambda frames, pose: None,
    'tool': lambda frames, pose: pose.rotation,
}
"""What turns each frame's axes into work axes; None where they are the same."""


def check_axes(frame: str) -> None:
    """Raises Refused, naming the frames that there are, for any other."""
    if frame not in AXES:
        raise Refused(f'frame {not_one_of(frame, list(AXES)[1:])}')


def in_work_axes(command: Array, frame: str, pose: Pose, frames: Frames) -> Array:
    """The pivot's twist (6,) in work axes; pose is T_work_pivot. Refused for unknown frames.

    '' and 'base': along the base's axes. 'work': along the work frame's. 'pivot': the same, for
    users who think of turns about the pivot. 'tool': along the axes of the tool in force, of the
    platform where there is none.
    """
    check_axes(frame)
    axes = AXES[frame](frames, pose)
    if axes is None:
        return command
    return np.concatenate([axes @ command[:3], axes @ command[3:]])


def within_speed(twist: Array, motion: MotionLimits) -> tuple[Array, float]:
    """The twist (6,) scaled as a whole, and the scale (1 when nothing was cut).

    Raises InvalidInput unless it is six finite numbers.
    """
    target = np.asarray(twist, dtype=np.float64)
    linear, angular = _sizes(target) if target.shape == (6,) else (math.nan, 0.0)
    if not math.isfinite(linear + angular):
        raise InvalidInput(f'twist {target.ravel().tolist()} is not six finite numbers')
    axes = map(truediv, map(abs, target.tolist()), motion.axis_speeds.tolist())
    part = max(linear / motion.linear.speed, angular / motion.angular.speed, *axes, 1.0)
    return (target, 1.0) if part == 1.0 else (target / part, 1.0 / part)


def towards(twist: Array, target: Array, motion: MotionLimits, dt: float) -> Array:
    """From `twist` (6,) as far to `target` as the accelerations allow in dt.

    Velocity and angular velocity change in the same proportion.
    """
    change = target - twist
    ticks = ticks_for(change, motion, dt)
    return target if ticks <= 1.0 else twist + change / ticks


def ticks_for(change: Array, motion: MotionLimits, dt: float) -> float:
    """How many times dt a change of twist (6,) takes at full acceleration."""
    linear, angular = _sizes(change)
    slowest = max(linear / motion.linear.acceleration, angular / motion.angular.acceleration)
    return slowest / dt


def _sizes(twist: Array) -> tuple[float, float]:
    """How fast a twist (6,) moves, in m/s and rad/s."""
    x, y, z, roll, pitch, yaw = twist.tolist()
    return math.hypot(x, y, z), math.hypot(roll, pitch, yaw)


STRAIGHT = frozen(np.zeros(6))


@dataclass(frozen=True, eq=False)
class LineState:
    """Where an arm's tool is beside its commanded line, for the jogger's next step.

    off_line (6,) is the twist that would bring it back onto the line within a second, base axes.
    is_leaving: it moves out of a singular posture, off the line. is_under_way: it has moved along
    the line, which it does not leave any more until it has been at rest.
    """

    off_line: Array = field(default_factory=lambda: STRAIGHT)
    is_leaving: bool = False
    is_under_way: bool = False


ON_LINE = LineState()


@dataclass(frozen=True, eq=False)
class JogMotion:
    """Where a jog has come to. Poses and twists are of the pivot in work axes.

    twist (6,) in m/s and rad/s is the one being driven, rates (n,) are the joints' in rad/s or
    m/s. scale is the part of the target twist that the machine allows, held_by what set it: '',
    'speed of joint 2', 'crank angle of leg 3', 'wrist singularity (…)'.

    Of an arm, for the jogger's next step: line, and along (6,), what of `twist` is along it.
    """

    pose: Pose
    joints: Array
    twist: Array
    rates: Array
    scale: float = 1.0
    held_by: str = ''
    line: LineState = ON_LINE
    along: Array = field(default_factory=lambda: STRAIGHT)

    @classmethod
    def at_rest(cls, pose: Pose, joints: Array) -> 'JogMotion':
        """Standing still; joints (n,) are the pose's."""
        return cls(pose, joints, frozen(np.zeros(6)), frozen(np.zeros(len(joints))))

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves."""
        return not (any(self.twist.tolist()) or any(self.rates.tolist()))


class Jogger(Protocol):
    """Follows twists, for one kind of machine; without state of its own."""

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """The motion dt seconds later, towards the target twist (6,).

        The twist is scaled as a whole, so that its direction stays; where it cannot, the machine
        stops, unless held_by says that it slides. A twist of zero brakes. From
        every motion that `step` returned it can brake inside the machine's limits.
        """
        ...
