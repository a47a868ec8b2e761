"""A commanded twist within the machine's limits of speed and acceleration."""

import math

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.motion_limits import MotionLimits


def within_speed(twist: Array, motion: MotionLimits) -> tuple[Array, float]:
    """The twist (6,) scaled as a whole, and the scale (1 when nothing was cut).

    Raises InvalidInput unless it is six finite numbers.
    """
    wanted = np.asarray(twist, dtype=np.float64)
    parts = wanted.ravel().tolist()
    if wanted.shape != (6,) or not all(map(math.isfinite, parts)):
        raise InvalidInput(f'twist {parts} is not six finite numbers')
    part = max(
        math.hypot(*parts[:3]) / motion.linear.speed,
        math.hypot(*parts[3:]) / motion.angular.speed,
        1.0,
    )
    return wanted / part, 1.0 / part


def towards(twist: Array, wanted: Array, motion: MotionLimits, dt: float) -> Array:
    """From `twist` (..., 6) as far to `wanted` as the accelerations allow in dt.

    Velocity and angular velocity go the same part of their ways.
    """
    change = wanted - twist
    ticks = np.maximum(ticks_for(change, motion, dt), 1.0)
    stepped: Array = twist + change / ticks[..., None]
    return np.where(ticks[..., None] == 1.0, wanted, stepped)


def ticks_for(change: Array, motion: MotionLimits, dt: float) -> Array:
    """How many times dt a change of twist (..., 6) takes at full acceleration."""
    linear = np.sqrt((change[..., :3] ** 2).sum(axis=-1)) / motion.linear.acceleration
    angular = np.sqrt((change[..., 3:] ** 2).sum(axis=-1)) / motion.angular.acceleration
    result: Array = np.maximum(linear, angular) / dt
    return result
