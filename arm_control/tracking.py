"""Joints along a row of poses on one branch: continuous, whatever the joint ranges say.

A branch ends where it does not close, or where another one would be needed: joints that would jump
there are for the caller to see. Ranges are not looked at: a joint that passes its stop is named by
the limit, and not turned back by 360° as `unwrapped` would.
"""

from collections.abc import Callable

import numpy as np

from arm_control.branches import TURN, nearby_joints
from arm_control.chain import Chain
from manipulator.arrays import Array
from manipulator.pose import Pose

SMALL = 0.1
"""Radians between two poses that only one and the same branch makes."""

MOST_SEARCHES = 50
"""Poses along one row at which all branches are searched for because Newton's method gave up."""


def tracked(branches: Array, near: Array) -> Array:
    """Of all branches (N, k, 6) of N poses, the one (N, 6) that goes on from joints `near`.

    It is the nearest to where the joints go on to at their speed: beside postures where two
    branches meet only the motion tells them apart. NaN where none closes.
    """
    joints = _of_one_row(branches, near)
    if joints is not None:
        return joints
    joints = np.full((len(branches), branches.shape[-1]), np.nan)
    last, step = near, np.zeros(branches.shape[-1])
    for i, found in enumerate(branches):
        continued = _continued(found, last + step)
        if continued is None:
            step = np.zeros_like(step)
            continue
        joints[i], step, last = continued, continued - last, continued
    return joints


def tracked_by_newton(
    chain: Chain, poses: Pose, near: Array, search: Callable[[Pose, Array], Array]
) -> Array:
    """As `tracked`, for an arm whose branches (k, 6) are costly to find: `search` finds them.

    Newton's method goes on from pose to pose; where it gives up, as beside singular postures, all
    branches are searched for, at MOST_SEARCHES poses at most. NaN from there on.
    """
    count = len(poses.position)
    joints = np.full((count, len(near)), np.nan)
    last, step, searches = near, np.zeros(len(near)), 0
    for i in range(count):
        pose = Pose.unchecked(poses.position[i], poses.rotation[i])
        nearby = nearby_joints(chain, pose, last + step)
        continued: Array | None = nearby
        if np.isnan(nearby).any():
            searches += 1
            if searches > MOST_SEARCHES:
                break
            continued = _continued(search(pose, last), last + step)
        if continued is None:
            step = np.zeros_like(step)
            continue
        joints[i], step, last = continued, continued - last, continued
    return joints


def _of_one_row(branches: Array, near: Array) -> Array | None:
    """The branch that begins nearest to `near`, where its own row goes on without a large step."""
    begin = _nearest_row(branches[0], near)
    if begin is None:
        return None
    joints: Array = np.unwrap(branches[:, begin], axis=0)
    joints += TURN * np.rint((near - joints[0]) / TURN)
    steps = np.abs(np.diff(joints, axis=0, prepend=near[None])).max()
    return joints if steps < SMALL else None


def _continued(branches: Array, ahead: Array) -> Array | None:
    """The branch (6,) nearest to `ahead` by whole turns; None where none closes."""
    row = _nearest_row(branches, ahead)
    if row is None:
        return None
    turned: Array = ahead + np.remainder(branches[row] - ahead + np.pi, TURN) - np.pi
    return turned


def _nearest_row(branches: Array, joints: Array) -> int | None:
    """Which of the branches (k, 6) is nearest to `joints` by whole turns; None without any."""
    away = np.abs(np.remainder(branches - joints + np.pi, TURN) - np.pi).max(axis=1)
    away[np.isnan(away)] = np.inf
    row = int(np.argmin(away))
    return row if np.isfinite(away[row]) else None
