"""Rods and their Jacobian, the same for crank and linear legs: docs/kinematics.md, section 4."""

import math

import numpy as np

from manipulator.arrays import Array
from manipulator.pose import Pose

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
