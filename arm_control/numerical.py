"""Inverse of any chain by damped Newton steps from many starts (docs/arm-kinematics.md, 6).

A calibrated arm, built almost as one with a closed form, starts at that one's branches. The
steps are in kernel/numerical.c, where they start in kernel/arm.c.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from arm_control.chain import JOINTS, Chain, aligned
from arm_control.closed_forms import ClosedForm
from manipulator import _kernel
from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

STARTS = 33
MOST_BRANCHES = 16
"""Of any arm with six joints."""


class Closes(IntEnum):
    """Which closed form an arm has, as kernel/arm.h says it."""

    NO_FORM = 0
    ALMOST = 1
    CLOSED = 2


def arm_numbers(
    chain: Chain, form: ClosedForm | None, length: float, low: Array, high: Array
) -> Array:
    """An arm in the order of `struct arm`: its chain, the closed form that it has, or almost."""
    closes = Closes.NO_FORM
    if form is not None:
        closes = Closes.CLOSED if form.chain is chain else Closes.ALMOST
    without = np.zeros(len(chain.numbers) + 4)
    numbers = without if form is None else form.numbers
    return frozen(np.concatenate([chain.numbers, numbers, [closes, length], low, high]))


@dataclass(frozen=True, eq=False)
class Numerical:
    """Levenberg–Marquardt with the error as damping (Sugihara, IEEE T-RO 27(5), 2011).

    length scales metres against radians; low and high span the cold starts.
    """

    chain: Chain
    length: float
    low: Array
    high: Array
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepares what the kernel is given."""
        numbers = arm_numbers(self.chain, None, self.length, self.low, self.high)
        object.__setattr__(self, 'numbers', numbers)

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    @property
    def form(self) -> None:
        """See `InverseMethod`."""
        return None

    def branches(self, pose: Pose, near: Array) -> Array:
        """What was found from `near`, which comes first, and from the cold starts: (..., 16, 6).

        A branch may be missed.
        """
        return arm_branches(self.numbers, pose, near)

    def refusal(self, pose: Pose) -> str:
        """How near the best attempt came."""
        miss = np.empty(6)
        _kernel.arm_miss(self.numbers, pose.position, pose.rotation, miss)
        distance, angle = np.linalg.norm(miss[:3]), np.degrees(np.linalg.norm(miss[3:]))
        return f'no joint angles found: the best of {STARTS} starts missed by ' + (
            f'{distance:.4g} m and {angle:.3g}°'
        )


@dataclass(frozen=True, eq=False)
class AlmostClosed:
    """What damped Newton steps find from `near` and from the eight branches of the ideal arm."""

    ideal: ClosedForm
    numerical: Numerical
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepares what the kernel is given."""
        own = self.numerical
        numbers = arm_numbers(own.chain, self.ideal, own.length, own.low, own.high)
        object.__setattr__(self, 'numbers', numbers)

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    @property
    def form(self) -> ClosedForm:
        """See `InverseMethod`."""
        return self.ideal

    def branches(self, pose: Pose, near: Array) -> Array:
        """All of them and NaN (..., 16, 6); for a pose that has none, what `Numerical` finds."""
        return arm_branches(self.numbers, pose, near)

    def refusal(self, pose: Pose) -> str:
        """Which triangle of the ideal arm does not close, or how near the real one comes."""
        is_out_of_reach = np.isnan(self.ideal.branches(pose, np.zeros(JOINTS))).all()
        return (self.ideal if is_out_of_reach else self.numerical).refusal(pose)


def arm_branches(numbers: Array, pose: Pose, near: Array) -> Array:
    """All branches (..., 16, 6) of an arm, by whole turns nearest to `near` within its ranges."""
    position, rotation, start = aligned(pose, near)
    found = np.empty((*start.shape[:-1], MOST_BRANCHES, JOINTS))
    _kernel.arm_branches(numbers, position, rotation, start, found)
    return found


ALMOST_PARALLEL, ALMOST_MEETING = np.radians(5.0), 0.005
"""How far axes may be from parallel (rad), and from meeting in one point (m)."""


def idealised(chain: Chain) -> Iterator[Chain]:
    """The chain with axes made parallel, and made to meet, where they almost are and do."""
    axes, points = chain.axes, chain.points
    for parallel, meeting in (((1, 2), (3, 4, 5)), ((1, 2, 3), (4, 5))):
        common, centre = _common(axes[list(parallel)]), _nearest(axes, points, meeting)
        if common is None or centre is None:
            continue
        directions, places = axes.copy(), points.copy()
        directions[list(parallel)] = np.sign(axes[list(parallel)] @ common)[:, None] * common
        places[list(meeting)] = centre
        yield Chain(directions, places, chain.home)


def _common(axes: Array) -> Array | None:
    """The mean direction (3,) of axes that are almost parallel, whichever way they point."""
    signs = np.sign(axes @ axes[0])
    total: Array = (signs[:, None] * axes).sum(axis=0)
    mean: Array = total / np.linalg.norm(total)
    sines = np.linalg.norm(np.cross(axes, mean), axis=1)
    return mean if sines.max() < np.sin(ALMOST_PARALLEL) else None


def _nearest(axes: Array, points: Array, which: Sequence[int]) -> Array | None:
    """The point (3,) nearest to some axes; None where they pass it too far away."""
    chosen, through = axes[list(which)], points[list(which)]
    across = np.eye(3) - chosen[:, :, None] * chosen[:, None, :]
    offsets = np.einsum('nij,nj->ni', across, through)
    point: Array = np.linalg.lstsq(across.reshape(-1, 3), offsets.ravel(), rcond=None)[0]
    missed = np.linalg.norm(np.einsum('nij,nj->ni', across, point - through), axis=1)
    return point if missed.max() < ALMOST_MEETING else None
