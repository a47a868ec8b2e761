"""Choosing among the branches of an inverse, and following one of them by Newton's method.

A choice looks at turns by 2π, joint ranges and nearness. All branches of a closed form cost as
much as ten steps of Newton's method beside a known pose, and a stream of setpoints needs only one.
"""

import numpy as np

from arm_control.chain import Chain
from manipulator.arrays import Array
from manipulator.pose import Pose

TURN = 2 * np.pi
SAME = 1e-6
"""Radians between two solutions of one branch that were found from different starts."""

OUTSIDE_COST = 1e6
"""What a radian outside the range costs against radians of distance: range comes first."""


def unwrapped(joints: Array, near: Array, low: Array, high: Array) -> Array:
    """`joints` moved by whole turns: nearest to `near` within [low, high] where a turn fits.

    Where none fits, the turn nearest to the range.
    """
    nearest = near + np.remainder(joints - near + np.pi, TURN) - np.pi
    up = np.ceil((low - nearest - 1e-12) / TURN).clip(min=0.0)
    down = np.ceil((nearest - high - 1e-12) / TURN).clip(min=0.0)
    moved = nearest + TURN * np.where(up > 0, up, -down)
    is_closer = _outside(moved, low, high) < _outside(nearest, low, high)
    result: Array = np.where(is_closer, moved, nearest)
    return result


def nearest_branch(branches: Array, near: Array, low: Array, high: Array) -> Array:
    """One (..., n) of the unwrapped branches (..., k, n); NaN where all are NaN.

    Joints that are beyond their range, by no more than `near` is, count as inside it: an arm that
    stands there stays on its branch.
    """
    distance = ((branches - near[..., None, :]) ** 2).sum(axis=-1)
    lowest, highest = np.minimum(low, near), np.maximum(high, near)
    outside = _outside(branches, lowest[..., None, :], highest[..., None, :])
    cost = distance + OUTSIDE_COST * outside.sum(axis=-1)
    best = np.argmin(np.where(np.isnan(cost), np.inf, cost), axis=-1)
    chosen: Array = np.take_along_axis(branches, best[..., None, None], axis=-2)[..., 0, :]
    return chosen


def without_repeats(branches: Array) -> Array:
    """Of branches (..., k, n) that are the same but for whole turns the first, the others NaN."""
    turns = np.exp(1j * branches)
    apart = np.abs(turns[..., :, None, :] - turns[..., None, :, :]).max(axis=-1)
    before = np.tri(branches.shape[-2], k=-1, dtype=np.bool_)
    is_repeat = ((apart < SAME) & before).any(axis=-1)
    result: Array = np.where(is_repeat[..., None], np.nan, branches)
    return result


def _outside(joints: Array, low: Array, high: Array) -> Array:
    return np.maximum(low - joints, 0.0) + np.maximum(joints - high, 0.0)


BESIDE = 0.05
"""Metres and radians from the known pose, and radians of the joints, that count as beside it."""
CONVERGED = 1e-12
STEPS = 4


def nearby_joints(chain: Chain, pose: Pose, near: Array) -> Array:
    """The joints (6,) that continue `near` to one pose; NaN where that is not certain.

    It is certain within BESIDE, away from singular postures, where the method converges at once.
    """
    joints = near
    for _ in range(STEPS):
        error = chain.forward(joints).twist_to(pose)
        largest = np.abs(error).max()
        if largest < CONVERGED:
            return joints
        if largest > BESIDE:
            break
        try:
            joints = joints + np.linalg.solve(chain.jacobian(joints), error)
        except np.linalg.LinAlgError:
            break
        if np.abs(joints - near).max() > BESIDE:
            break
    return np.full(len(near), np.nan)
