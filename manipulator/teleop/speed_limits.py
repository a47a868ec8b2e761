"""A commanded twist within the machine's speed limits, its direction kept."""

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.motion_limits import MotionLimits


def within_speed(twist: Array, motion: MotionLimits) -> tuple[Array, float]:
    """The twist (6,) scaled as a whole, and the scale (1 when nothing was cut).

    Raises InvalidInput unless it is six finite numbers.
    """
    wanted = np.asarray(twist, dtype=np.float64)
    if wanted.shape != (6,) or not np.isfinite(wanted).all():
        raise InvalidInput(f'twist {wanted.tolist()} is not six finite numbers')
    part = max(
        float(np.linalg.norm(wanted[:3])) / motion.linear.speed,
        float(np.linalg.norm(wanted[3:])) / motion.angular.speed,
        1.0,
    )
    return wanted / part, 1.0 / part
