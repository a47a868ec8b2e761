"""Six coordinates about a reference orientation R₀: the position, and w with R = exp(w)·R₀.

Position and w are taken together as x (..., 6); x, its first and its second derivative make a
MotionState and back. docs/motion.md, section 2.
"""

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.pose import Pose
from manipulator.trajectory.plan import MotionState

DIFFERENCE_STEP = 1e-4


def coordinates(state: MotionState, reference: Array) -> tuple[Array, Array, Array]:
    """One state in the chart about `reference` (3, 3): (6,) coordinates and two derivatives."""
    w = so3.log(state.pose.rotation @ reference.T)
    inverse = np.linalg.inv(so3.left_jacobian(w))
    w_rate = inverse @ state.twist[3:]
    w_acceleration = inverse @ (state.acceleration[3:] - _jacobian_change(w, w_rate))
    return (
        np.concatenate([state.pose.position, w]),
        np.concatenate([state.twist[:3], w_rate]),
        np.concatenate([state.acceleration[:3], w_acceleration]),
    )


def state_of(x: Array, v: Array, a: Array, reference: Array) -> MotionState:
    """The inverse of `coordinates`, for arrays of any shape; reference (..., 3, 3)."""
    w, w_rate = x[..., 3:], v[..., 3:]
    jacobian = so3.left_jacobian(w)
    omega = np.einsum('...ij,...j->...i', jacobian, w_rate)
    alpha = np.einsum('...ij,...j->...i', jacobian, a[..., 3:]) + _jacobian_change(w, w_rate)
    return MotionState(
        Pose(x[..., :3], so3.exp(w) @ reference),
        np.concatenate([v[..., :3], omega], axis=-1),
        np.concatenate([a[..., :3], alpha], axis=-1),
    )


def _jacobian_change(w: Array, w_rate: Array) -> Array:
    """J̇(w)·ẇ by a central difference along ẇ."""
    h = DIFFERENCE_STEP
    ahead, behind = so3.left_jacobian(w + h * w_rate), so3.left_jacobian(w - h * w_rate)
    change: Array = np.einsum('...ij,...j->...i', (ahead - behind) / (2 * h), w_rate)
    return change
