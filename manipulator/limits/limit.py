"""What a limit is: named values of a configuration and the range that each must keep."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.pose import Pose

FEWEST_DIGITS, MOST_DIGITS = 4, 12
ROUNDING = 1e-9
"""Of a tick, by which braking may take a whole number of them longer."""


class Limit(Protocol):
    """k values computed from a pose and its joints, each with its own range.

    quantity and unit go into messages; owners are who each value belongs to ('leg 3', or '' when
    it is the whole platform's). Where the quantity is '', owners are sentences that become true
    below 0 metres, as 'link 3 meets the floor'.
    """

    @property
    def quantity(self) -> str:
        """What is limited, as 'crank angle'."""
        ...

    @property
    def unit(self) -> str:
        """The unit of values and bounds, '' for a ratio."""
        ...

    @property
    def owners(self) -> tuple[str, ...]:
        """Whose each of the k values is."""
        ...

    @property
    def low(self) -> Array:
        """Lower bounds (k,), −∞ where there is none."""
        ...

    @property
    def high(self) -> Array:
        """Upper bounds (k,), ∞ where there is none."""
        ...

    def values(self, pose: Pose, joints: Array) -> Array:
        """The limited values (..., k); NaN counts as outside."""
        ...


Bounds: TypeAlias = tuple[slice, Array, Array]
"""Columns of a group's values, and the lowest and highest that each may be."""


class LimitGroup(Protocol):
    """A machine that computes the values of many limits at once, and judges them."""

    @property
    def of_pose(self) -> slice:
        """Columns of x, y, z, tilt and turn: limits/task_space.py."""
        ...

    def limited_values(self, pose: Pose, joints: Array) -> Array:
        """All values (..., K), NaN where there is none."""
        ...

    def ranges(self, bounds: Sequence[Bounds]) -> Array:
        """The ranges of some columns, the strictest of each, as `keeps` takes them."""
        ...

    def keeps(self, ranges: Array, pose: Pose, joints: Array) -> Mask:
        """Which configurations (...) have finite joints and all values in their ranges."""
        ...

    def descended(self, search: 'Search', bounds: Sequence[Bounds], start: Pose) -> Pose:
        """From an admitted pose to one at a local minimum of the distance, within the bounds."""
        ...

    def first_free_path(self, ranges: Array, paths: 'BrakingPaths') -> tuple[int, Array]:
        """The first of the paths that nothing holds back, their number if there is none.

        And the paths (k, 20) up to it, `struct braking_path` of kernel/braking.h each.
        """
        ...


@dataclass(frozen=True, eq=False)
class Search:
    """What `descended` looks for: the pose nearest to `target`.

    clearance (m) is how far inside every limit it stays, to first order; pivot (3,) the point of
    the platform, in its frame, whose poses are meant.
    """

    target: Pose
    clearance: float
    most_steps: int
    pivot: Array = field(default_factory=lambda: frozen(np.zeros(3)))


@dataclass(frozen=True, eq=False)
class BrakingPaths:
    """One tick at each of the twists (k, 6), then braking to rest: what `first_free_path` judges.

    From pose, joints (n,) and their rates (n,); bounds and frame are `jog_bounds` and `jog_frame`
    of kernel/braking.h, the frame None where poses are the platform's own.
    """

    bounds: Array
    pose: Pose
    joints: Array
    rates: Array
    twists: Array
    frame: Array | None = None

    def poses(self, twist: Array) -> Pose:
        """Those at the ticks of one of the paths (N,), of the pivot in the work frame."""
        dt, linear, angular = self.bounds[:3]
        longest = max(np.linalg.norm(twist[:3]) / linear, np.linalg.norm(twist[3:]) / angular) / dt
        ticks = int(np.ceil(max(longest - ROUNDING, 1.0)))
        shares = np.cumsum(1.0 - np.arange(ticks) / ticks)
        return self.pose.moved(dt * shares[:, None] * twist)

    def of_platform(self, poses: Pose) -> Pose:
        """Those of the platform in the base frame, for poses of the pivot in the work frame."""
        if self.frame is None:
            return poses
        work = Pose(self.frame[:3], self.frame[3:12].reshape(3, 3))
        return work @ poses @ Pose(-self.frame[12:], np.eye(3))


@runtime_checkable
class Grouped(Protocol):
    """A limit whose values are `columns` of those of a group, unless the group is None."""

    @property
    def group(self) -> LimitGroup | None:
        """What computes them."""
        ...

    @property
    def columns(self) -> slice:
        """Where they stand there."""
        ...


@dataclass(frozen=True, eq=False)
class GroupedLimit:
    """A `Limit` on some of a group's `limited_values`, within [low, high] each."""

    group: LimitGroup
    columns: slice
    quantity: str
    unit: str
    owners: tuple[str, ...]
    low: Array
    high: Array

    def values(self, pose: Pose, joints: Array) -> Array:
        """The limited values (..., k)."""
        return self.group.limited_values(pose, joints)[..., self.columns]


@dataclass(frozen=True)
class Violation:
    """One value outside its range; `excess` ≥ 0 is by how much."""

    quantity: str
    unit: str
    owner: str
    value: float
    low: float
    high: float

    @property
    def excess(self) -> float:
        """How far outside, in the limit's unit; NaN for a value that does not exist."""
        return max(self.low - self.value, self.value - self.high)

    def __str__(self) -> str:
        """As 'leg 3: crank angle 3.92 rad outside [0.52, 3.67]', 'rod 1 meets rod 2 by 4 mm'."""
        if not self.quantity:
            return f'{self.owner} by {1e3 * self.excess:.3g} mm'
        owner = f'{self.owner}: ' if self.owner else ''
        unit = f' {self.unit}' if self.unit else ''
        digits = self.digits
        return f'{owner}{self.quantity} {self.value:.{digits}g}{unit} {self._range_text(digits)}'

    @property
    def digits(self) -> int:
        """Four, or as many as distinguish the value from the bound that it is beyond."""
        for digits in range(FEWEST_DIGITS, MOST_DIGITS):
            value, low, high = (f'{x:.{digits}g}' for x in (self.value, self.low, self.high))
            if value not in (low, high):
                return digits
        return MOST_DIGITS

    def _range_text(self, digits: int) -> str:
        low, high = (f'{bound:.{digits}g}' for bound in (self.low, self.high))
        if not np.isfinite(self.high):
            return f'below {low}'
        return f'outside [{low}, {high}]' if np.isfinite(self.low) else f'above {high}'


@dataclass(frozen=True, eq=False)
class LimitOf:
    """A limit with the quantity, unit, owners and group of `inner`."""

    inner: Limit

    @property
    def group(self) -> LimitGroup | None:
        """That of the limit."""
        return self.inner.group if isinstance(self.inner, Grouped) else None

    @property
    def columns(self) -> slice:
        """Those of the limit."""
        return self.inner.columns if isinstance(self.inner, Grouped) else slice(0)

    @property
    def quantity(self) -> str:
        """That of the limit."""
        return self.inner.quantity

    @property
    def unit(self) -> str:
        """That of the limit."""
        return self.inner.unit

    @property
    def owners(self) -> tuple[str, ...]:
        """Those of the limit."""
        return self.inner.owners
