"""Rods and their Jacobian, the same for crank and linear legs: docs/kinematics.md, section 4.

Arrays have legs first and poses last, which is quick for many poses. Whether σmin keeps a margin
is tested without singular values: σmin(J) ≥ m exactly when JᵀJ − m²I has no eigenvalue below 0,
which the signs of its pivots tell.
"""

import math
from collections.abc import Iterator

import numpy as np

from manipulator.arrays import Array, Mask
from manipulator.pose import Pose

MANY = 64  # poses from which on columns are quicker than a matrix for each pose
CHUNK = 1024  # poses at once: what they need stays in the cache


def unit_rods_and_arms(
    base_points: Array, platform_points: Array, pose: Pose
) -> tuple[Array, Array]:
    """Unit rod directions and R aᵢ, both (3, 6, N) in base axes, of N poses.

    base_points (6, 3) or (N, 6, 3), platform_points (6, 3), metres.
    """
    count = pose.position.shape[0]
    arms = turned_columns(platform_points, pose)
    rods = arms + pose.position.T[:, None, :]
    rods -= np.moveaxis(np.broadcast_to(base_points, (count, 6, 3)), (0, 1, 2), (2, 1, 0))
    rods /= np.sqrt((rods * rods).sum(axis=0))
    return rods, arms


def turned_columns(vectors: Array, pose: Pose) -> Array:
    """R v (3, k, N) of vectors (k, 3), for N poses."""
    turned = pose.rotation.reshape(-1, 3) @ vectors.T
    return np.ascontiguousarray(np.moveaxis(turned.reshape(-1, 3, len(vectors)), 0, -1))


def chunks(pose: Pose, joints: Array) -> Iterator[tuple[slice, Pose, Array]]:
    """Parts of N poses with their joints (N, n), and where they stand."""
    for start in range(0, len(joints), CHUNK):
        part = slice(start, start + CHUNK)
        yield part, Pose.unchecked(pose.position[part], pose.rotation[part]), joints[part]


YZX, ZXY = [1, 2, 0], [2, 0, 1]


def rods(base_points: Array, platform_points: Array, pose: Pose) -> Array:
    """Vectors (..., 6, 3) from base points (..., 6, 3) to platform joints, base axes, metres."""
    result: Array = pose.transform(platform_points) - base_points
    return result


def leg_jacobian(base_points: Array, platform_points: Array, pose: Pose) -> Array:
    """J (..., 6, 6) with J·twist = the rate at which each rod's length would grow, in m/s.

    Row i is (uᵢ, R aᵢ × uᵢ) with the unit rod direction uᵢ. Base points may be (6, 3), or differ
    from pose to pose.
    """
    arms = platform_points @ np.swapaxes(pose.rotation, -1, -2)
    rod = arms + pose.position[..., None, :] - base_points
    unit = rod / np.sqrt((rod * rod).sum(axis=-1))[..., None]
    jacobian = np.empty((*unit.shape[:-1], 6))
    jacobian[..., :3] = unit
    moment = arms[..., YZX] * unit[..., ZXY]  # the cross product, which numpy's own is slow at
    moment -= arms[..., ZXY] * unit[..., YZX]
    jacobian[..., 3:] = moment
    return jacobian


def smallest_singular_value(jacobian: Array, characteristic_length: float) -> Array:
    """σmin (...) of a leg Jacobian whose rotations are scaled by a length; NaN for NaN."""
    scaled = jacobian.copy()
    scaled[..., 3:] /= characteristic_length
    if math.isfinite(scaled.sum()):
        return np.asarray(np.linalg.svd(scaled, compute_uv=False)[..., -1])
    finite = np.isfinite(scaled).all(axis=(-1, -2))
    safe = np.where(finite[..., None, None], scaled, 0.0)
    result: Array = np.where(finite, np.linalg.svd(safe, compute_uv=False)[..., -1], np.nan)
    return result


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
