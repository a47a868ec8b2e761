"""Rows of joints along a path: where they jump, another branch of the inverse begins."""

import numpy as np

from manipulator.arrays import Array

BRANCH_JUMP = 0.5
"""A step of a joint (rad) between two neighbours that only another branch of the inverse makes."""


def first_jump(joints: Array) -> int | None:
    """The first row of (N, n) from which a joint jumps to the next; None where none does."""
    steps = np.abs(np.diff(joints, axis=0)).max(axis=-1, initial=0.0)
    jumps = np.flatnonzero(steps > BRANCH_JUMP)
    return int(jumps[0]) if jumps.size else None
