"""Joints along a way: each set on the branch of the one before it."""

import numpy as np

from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose

BRANCH_JUMP = 0.5
"""A step of a joint (rad) between two neighbours that only another branch of the inverse makes."""


SAME = 0.02
"""Difference of joints (rad or m) that is a measurement's, not another branch's."""


def joints_along(machine: Machine, poses: Pose, near: Array) -> Array:
    """Joints for a row of poses, each on the branch nearest to the last one that closes.

    A machine that begins on home's branch stays there, as long as that is continuous: where
    branches meet, and far from the joints at the start, nearness alone cannot tell.
    """
    kinematics = machine.kinematics
    as_home = kinematics.inverse_or_nan(poses)
    if (np.abs(as_home[0] - near) < SAME).all() and not _has_jump(as_home):
        return as_home
    joints = kinematics.inverse_or_nan(poses, near)
    if _has_jump(joints):
        first = int(np.argmax(_jumps(joints))) + 1
        last = joints[first - 1]
        for i in range(first, len(joints)):
            joints[i] = kinematics.inverse_or_nan(poses[i], last)
            last = joints[i] if np.isfinite(joints[i]).all() else last
    return joints


def _jumps(joints: Array) -> Mask:
    jumps: Mask = np.abs(np.diff(joints, axis=0)).max(axis=-1) > BRANCH_JUMP
    return jumps


def _has_jump(joints: Array) -> bool:
    return bool(_jumps(joints).any())
