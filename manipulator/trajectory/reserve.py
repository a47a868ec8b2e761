"""What the motion of a reference leaves of the speed and acceleration limits, for a correction.

A stream of goals is as smooth as its user makes it: a correction adds little to its acceleration.
"""

import numpy as np

from manipulator.arrays import Array
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose

SPEED_SHARE = 0.4
"""Of the speed that is left, what a correction may use: it can then brake as fast as that shrinks
while a plan speeds up."""

ADDED = 0.2
"""Of the share of the acceleration limits that a stream uses: what a correction may use."""

REMEMBERED = 2.0
"""Seconds in which the acceleration of a stream is forgotten."""

TINY = 1e-12


class Reserve:
    """Follows the reference's pose and joints (n,), tick by tick."""

    def __init__(self, dt: float) -> None:
        self._dt = dt
        self._pose: Pose | None = None
        self._joints: Array = np.zeros(0)
        self._speed: Array = np.zeros(0)
        self._acceleration: Array = np.zeros(0)
        self._most: Array = np.zeros(2)
        self._is_stream = False

    def note(self, pose: Pose, joints: Array, is_stream: bool) -> None:
        """Takes the reference of this tick; is_stream: it follows a stream of goals."""
        speed = np.zeros(6 + len(joints))
        if self._pose is not None:
            moved = np.concatenate([self._pose.twist_to(pose), joints - self._joints])
            speed = moved / self._dt
        before = self._speed if len(self._speed) else speed
        self._acceleration = (speed - before) / self._dt
        self._pose, self._joints, self._speed = pose, joints, speed
        kept = (1.0 - self._dt / REMEMBERED) * self._most
        self._most = np.maximum(kept, _sizes(self._acceleration[:6], joints)[:2])
        self._is_stream = is_stream

    def speed_share(
        self, motion: MotionLimits, joints: Array, twist: Array, fastest: float
    ) -> float:
        """How fast a rest, of joints (n,) and of the pose (6,), may be covered: 1/s.

        So that the acceleration that is left brakes it in time; at most `fastest`.
        """
        left = self._left(motion, 'speed', self._speed)
        speed = SPEED_SHARE * _share(left, joints, twist)
        left = self._left(motion, 'acceleration', self._acceleration)
        braking = float(np.sqrt(0.5 * _share(left, joints, twist)))
        return min(speed, braking, fastest)

    def change_share(self, motion: MotionLimits, joints: Array, twist: Array) -> float:
        """The part of a change of speed that the acceleration limits leave to this tick."""
        left = self._left(motion, 'acceleration', self._acceleration)
        return min(self._dt * _share(left, joints, twist), 1.0)

    def _left(self, motion: MotionLimits, kind: str, used: Array) -> Array:
        """Of linear, angular, each axis's and each joint's limit, (8 + n,)."""
        limits = np.concatenate(
            [
                [getattr(motion.linear, kind), getattr(motion.angular, kind)],
                motion.axis_speeds if kind == 'speed' else np.full(6, np.inf),
                np.broadcast_to(getattr(motion.joint, kind), len(used) - 6),
            ]
        )
        left: Array = np.maximum(limits - _sizes(used[:6], used[6:]), 0.0)
        if kind == 'acceleration' and self._is_stream:
            share = ADDED * float((self._most / limits[:2]).max())
            left = np.minimum(left, max(share, TINY) * limits)
        return left


def _share(left: Array, joints: Array, twist: Array) -> float:
    """The largest factor with which a change keeps what is left (8 + n,)."""
    return float((left / np.maximum(_sizes(twist, joints), TINY)).min())


def _sizes(twist: Array, joints: Array) -> Array:
    """What each of the limits is on, (8 + n,)."""
    norms = np.linalg.norm(twist[:3]), np.linalg.norm(twist[3:])
    return np.concatenate([norms, np.abs(twist), np.abs(joints)])
