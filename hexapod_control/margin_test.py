"""Whether σmin keeps a margin, for many poses at once and without singular values.

σmin(J) ≥ m exactly when JᵀJ − m²I has no eigenvalue below 0, which the signs of its pivots tell.
"""

import numpy as np

from hexapod_control.columns import unit_rods_and_arms
from manipulator.arrays import Array, Mask
from manipulator.pose import Pose


def keeps_margin(
    base_points: Array, platform_points: Array, pose: Pose, length: float, minimum: float
) -> Mask:
    """Which of N poses have σmin above `minimum`; rotations scaled by `length`. NaN does not."""
    unit, arms = unit_rods_and_arms(base_points, platform_points, pose)
    rows = np.empty((6, *unit.shape[1:]))
    rows[:3] = unit
    rows[3] = arms[1] * unit[2] - arms[2] * unit[1]
    rows[4] = arms[2] * unit[0] - arms[0] * unit[2]
    rows[5] = arms[0] * unit[1] - arms[1] * unit[0]
    rows[3:] /= length
    square = [np.einsum('ln,kln->kn', rows[i], rows[i:]) for i in range(6)]
    for i in range(6):
        square[i][0] -= minimum * minimum
    return _pivots_are_positive(square)


def _pivots_are_positive(upper: list[Array]) -> Mask:
    """Of symmetric matrices, whose row i from the diagonal on is upper[i] (6 − i, N); consumed."""
    positive: Mask = upper[0][0] > 0.0
    with np.errstate(invalid='ignore', divide='ignore', over='ignore'):
        for i in range(len(upper) - 1):
            factors = upper[i][1:] / upper[i][0]
            for j in range(i + 1, len(upper)):
                upper[j] -= factors[j - i - 1] * upper[i][j - i :]
            positive &= upper[i + 1][0] > 0.0
    return positive
