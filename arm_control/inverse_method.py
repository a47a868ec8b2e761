"""What the inverses of a chain have in common, and which one fits a chain."""

from typing import Protocol

import numpy as np

from arm_control.chain import Chain
from arm_control.closed_forms import ParallelAxes, SphericalWrist
from arm_control.geometry import JointLimits
from arm_control.numerical import AlmostClosed, Numerical, idealised
from manipulator.arrays import Array
from manipulator.pose import Pose

EXACT = 1e-9
"""Metres, and sines of angles: how well axes must meet or be parallel for a closed form."""


class InverseMethod(Protocol):
    """All joint angles of a pose, on every branch that the method knows."""

    @property
    def is_explicit(self) -> bool:
        """Whether it is a closed form."""
        ...

    def branches(self, pose: Pose, near: Array) -> Array:
        """Joints (..., k, 6), not yet unwrapped; NaN rows for branches that do not close.

        near (..., 6) gives the joints that the pose leaves free, as in an aligned wrist.
        """
        ...

    def along(self, poses: Pose, near: Array) -> Array:
        """The branch (N, 6) that goes on from joints `near` (6,) through N poses; see tracking.py.

        Continuous, also beyond the joint ranges; NaN where it does not close.
        """
        ...

    def refusal(self, pose: Pose) -> str:
        """Why one pose has no branch: what, how far, and how far would be reachable."""
        ...


def fitting_method(chain: Chain, limits: JointLimits, length: float) -> InverseMethod:
    """The closed form that the chain admits, or almost, else the numerical one (length in m)."""
    closed = closed_form(chain)
    if closed is not None:
        return closed
    numerical = Numerical(chain, length, limits.low, limits.high)
    for ideal in idealised(chain):
        closed = closed_form(ideal)
        if closed is not None:
            return AlmostClosed(closed, numerical)
    return numerical


def closed_form(chain: Chain) -> SphericalWrist | ParallelAxes | None:
    """The one whose conditions the axes meet."""
    axes = chain.axes
    if _are_parallel(axes[1], axes[2]) and not _are_parallel(axes[0], axes[1]):
        centre = _meeting_point(chain, 4, 5)
        if centre is not None and _is_on_axis(chain, 3, centre):
            return SphericalWrist(chain, centre)
        if centre is not None and _are_parallel(axes[1], axes[3]):
            return ParallelAxes(chain, centre)
    return None


def _are_parallel(a: Array, b: Array) -> bool:
    return bool(np.linalg.norm(np.cross(a, b)) < EXACT)


def _is_on_axis(chain: Chain, joint: int, point: Array) -> bool:
    off_axis = np.cross(chain.axes[joint], point - chain.points[joint])
    return bool(np.linalg.norm(off_axis) < EXACT)


def _meeting_point(chain: Chain, first: int, second: int) -> Array | None:
    """Where two axes meet, None when they pass each other or run parallel."""
    a, b = chain.axes[first], chain.axes[second]
    if _are_parallel(a, b):
        return None
    p, q = chain.points[first], chain.points[second]
    along, *_ = np.linalg.lstsq(np.stack([a, -b], axis=1), q - p, rcond=None)
    point: Array = p + along[0] * a
    return point if _is_on_axis(chain, second, point) else None
