"""Closed-form inverses: all branches of two kinds of arms (docs/arm-kinematics.md, 4 and 5).

Arms whose last three axes meet in one point have eight; so have arms built as the UR5, with
joints 2, 3 and 4 parallel and axes 5 and 6 meeting. Their formulas are in kernel/closed_forms.c.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from arm_control.chain import JOINTS, Chain, aligned
from manipulator import _kernel
from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

EXACT = 1e-9
"""Metres, and sines of angles: how well axes must meet or be parallel for a closed form."""

BRANCHES = 8
"""Two of joint 1, times two elbows, times two wrists."""


@dataclass(frozen=True, eq=False)
class ClosedForm(ABC):
    """`centre` (3,) is where axes 5 and 6 meet at zero angles, in metres.

    numbers are the chain, the centre and the kind, in the order of `struct closed_form`.
    """

    chain: Chain
    centre: Array
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepares what the kernel is given."""
        parts = self.chain.numbers, self.centre, [float(self.has_parallel_axes)]
        object.__setattr__(self, 'numbers', frozen(np.concatenate(parts)))

    @property
    @abstractmethod
    def has_parallel_axes(self) -> bool:
        """Whether axis 4 is parallel to 2 and 3, too."""

    @property
    @abstractmethod
    def tip(self) -> str:
        """What joints 1 to 3 bring to its place."""

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return True

    @property
    def form(self) -> 'ClosedForm':
        """See `InverseMethod`."""
        return self

    def arm_numbers(self, length: float, low: Array, high: Array) -> Array:
        """See `InverseMethod`."""
        return arm_numbers(self.chain, self, length, low, high)

    def branches(self, pose: Pose, near: Array) -> Array:
        """All eight (..., 8, 6): two of joint 1, times two elbows, times two wrists."""
        position, rotation, start = aligned(pose, near)
        branches = np.empty((*start.shape[:-1], BRANCHES, JOINTS))
        _kernel.closed_branches(self.numbers, position, rotation, start, branches)
        return branches

    def refusal(self, pose: Pose) -> str:
        """Which triangle of the arm does not close."""
        gap = np.empty(4)
        _kernel.closed_gap(self.numbers, pose.position, pose.rotation, gap)
        is_at_shoulder, distance, least, most = gap.tolist()
        if not is_at_shoulder:
            place = f"wrist centre {distance:.4g} m from joint 1's axis"
            return f'{place}, needs at least {least:.4g} m'
        bound = f'reach is {most:.4g} m' if distance > most else f'needs at least {least:.4g} m'
        return f'{self.tip} {distance:.4g} m from the shoulder, {bound}'


class SphericalWrist(ClosedForm):
    """Joints 2 and 3 parallel, axes 4, 5, 6 through `centre` (docs/arm-kinematics.md, 4)."""

    has_parallel_axes = False
    tip = 'wrist centre'


class ParallelAxes(ClosedForm):
    """Joints 2, 3 and 4 parallel, axes 5 and 6 through `centre` (docs/arm-kinematics.md, 5)."""

    has_parallel_axes = True
    tip = "joint 4's axis"


NO_LOOP, MOST_LOOPS = -1, 4
"""Instead of a loop for elimination; how many an arm has."""


class Closes(IntEnum):
    """Which closed form an arm has, as in kernel/arm.h."""

    NO_FORM = 0
    ALMOST = 1
    CLOSED = 2


def arm_numbers(
    chain: Chain,
    form: ClosedForm | None,
    length: float,
    low: Array,
    high: Array,
    general: Array | None = None,
) -> Array:
    """An arm in the order of `struct arm`: its chain, the closed form that it has, or almost.

    length in m; low and high (6,) in rad. general is what `Numerical` adds: loops, mirror, and the
    chain that is eliminated.
    """
    closes = Closes.NO_FORM
    if form is not None:
        closes = Closes.CLOSED if form.chain is chain else Closes.ALMOST
    without = np.zeros(len(chain.numbers) + 4)
    numbers = without if form is None else form.numbers
    none = np.zeros(MOST_LOOPS + 3 + len(chain.numbers))
    rest = none if general is None else general
    return frozen(np.concatenate([chain.numbers, numbers, [closes, length], low, high, rest]))


def closed_form(chain: Chain) -> ClosedForm | None:
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
