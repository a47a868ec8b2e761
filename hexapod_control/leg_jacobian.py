"""Rods and their Jacobian, the same for crank and linear legs: docs/kinematics.md, section 4."""

import numpy as np

from manipulator import _kernel
from manipulator.arrays import Array, stretched
from manipulator.pose import Pose


def rods(base_points: Array, platform_points: Array, pose: Pose) -> Array:
    """Vectors (..., 6, 3) from base points (..., 6, 3) to platform joints, base axes, metres."""
    result: Array = pose.transform(platform_points) - base_points
    return result


def leg_jacobian(base_points: Array, platform_points: Array, pose: Pose) -> Array:
    """J (..., 6, 6) with J·twist = the rate at which each rod's length would grow, in m/s.

    Row i is (uᵢ, R aᵢ × uᵢ) with the unit rod direction uᵢ. Base points may be (6, 3), or differ
    from pose to pose.
    """
    return units_and_jacobian(base_points, platform_points, pose)[1]


def units_and_jacobian(
    base_points: Array, platform_points: Array, pose: Pose
) -> tuple[Array, Array]:
    """The unit rod directions (..., 6, 3) in base axes, and `leg_jacobian`."""
    position, rotation, base = pose.position, pose.rotation, base_points
    leading = np.broadcast_shapes(position.shape[:-1], np.shape(base)[:-2])
    units, jacobian = np.empty((*leading, 6, 3)), np.empty((*leading, 6, 6))
    _kernel.leg_jacobian(
        stretched(platform_points, (6, 3)),
        stretched(base, units.shape),
        stretched(position, (*leading, 3)),
        stretched(rotation, (*leading, 3, 3)),
        units,
        jacobian,
    )
    return units, jacobian


def smallest_singular_value(jacobian: Array, characteristic_length: float) -> Array:
    """σmin (...) of a leg Jacobian whose rotations are scaled by a length; NaN for NaN."""
    sigma, length = np.empty(jacobian.shape[:-2]), np.array([characteristic_length])
    rows = stretched(jacobian, (*sigma.shape, 6, 6))
    _kernel.smallest_singular_value(length, rows, sigma)
    return sigma
