"""Joints along a way: each set on the branch of the one before it."""

import numpy as np

from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

BRANCH_JUMP = 0.5
"""A step of a joint (rad) between two neighbours that only another branch of the inverse makes."""


def joints_along(machine: Machine, poses: Pose, near: Array) -> Array:
    """Joints for a row of poses, each on the branch nearest to the last one that closes."""
    kinematics = machine.kinematics
    joints = kinematics.inverse_or_nan(poses, near)
    jumps = np.abs(np.diff(joints, axis=0)).max(axis=-1) > BRANCH_JUMP
    if jumps.any():
        first = int(np.argmax(jumps)) + 1
        last = joints[first - 1]
        for i in range(first, len(joints)):
            joints[i] = kinematics.inverse_or_nan(poses[i], last)
            last = joints[i] if np.isfinite(joints[i]).all() else last
    return joints
