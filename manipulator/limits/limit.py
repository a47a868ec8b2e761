"""What a limit is: named values of a configuration and the range that each must keep."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from manipulator.arrays import Array, Mask
from manipulator.pose import Pose

FEWEST_DIGITS, MOST_DIGITS = 4, 12


class Limit(Protocol):
    """k values computed from a pose and its joints, each with its own range.

    quantity and unit go into messages; owners are who each value belongs to ('leg 3', or '' when
    it is the whole platform's). A limit that can decide faster than by its values what it admits
    may offer `admits(pose, joints) -> Mask` as well.
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


def admitted(limit: Limit, pose: Pose, joints: Array) -> Mask:
    """Which configurations (...) keep one limit."""
    quick: Callable[[Pose, Array], Mask] | None = getattr(limit, 'admits', None)
    if quick is not None:
        return quick(pose, joints)
    values = limit.values(pose, joints)
    inside = (values >= limit.low) & (values <= limit.high)
    return np.asarray(inside.all(axis=-1), dtype=np.bool_)


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
        """As 'leg 3: crank angle 3.92 rad outside [0.52, 3.67]'."""
        owner = f'{self.owner}: ' if self.owner else ''
        unit = f' {self.unit}' if self.unit else ''
        digits = self._digits
        return f'{owner}{self.quantity} {self.value:.{digits}g}{unit} {self._range_text(digits)}'

    @property
    def _digits(self) -> int:
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
    """A limit with the quantity, unit and owners of `inner`."""

    inner: Limit

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
