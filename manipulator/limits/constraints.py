"""The one constraint check that ik, trajectories, teleop and workspace maps share.

A limit that a machine is beyond is stretched for the way back.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.errors import InvalidInput, LimitViolated
from manipulator.limits.limit import (
    Bounds,
    Grouped,
    Limit,
    LimitGroup,
    LimitOf,
    Search,
    Violation,
)
from manipulator.pose import Pose

ROUNDING = 1e-9
"""rad, m or a ratio by which values may differ when the same pose is computed again: the joints of
a pose that was found from joints at the end of their range may be beyond it by as much."""

FEW = 3
"""As many limits a message names: a stack has more than a hundred."""


@dataclass(frozen=True)
class Constraints:
    """All limits of a machine on its configuration (pose and joints together).

    What a group of limits has in common is computed once.
    """

    limits: tuple[Limit, ...]
    names: tuple[tuple[str, str, str], ...] = field(init=False, compare=False, repr=False)
    low: Array = field(init=False, compare=False, repr=False)
    high: Array = field(init=False, compare=False, repr=False)
    places: tuple[tuple[LimitGroup | None, slice], ...] = field(
        init=False, compare=False, repr=False
    )
    bounds: tuple[Sequence[Bounds], ...] = field(init=False, compare=False, repr=False)
    checks: tuple[tuple[LimitGroup, Array], ...] = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Puts all values in a row: names (quantity, owner, unit), bounds, who computes them."""
        limits = self.limits
        places = tuple(_place(limit) for limit in limits)
        parts: dict[LimitGroup, list[Bounds]] = {}
        for (group, columns), limit in zip(places, limits, strict=True):
            if group is not None:
                parts.setdefault(group, []).append((columns, limit.low, limit.high))
        for name, value in {
            'names': tuple(
                (limit.quantity, o, limit.unit) for limit in limits for o in limit.owners
            ),
            'low': frozen(np.concatenate([[], *(limit.low for limit in limits)])),
            'high': frozen(np.concatenate([[], *(limit.high for limit in limits)])),
            'places': places,
            'bounds': tuple(parts.values()),
            'checks': tuple(
                (group, group.ranges([_widened(*bounds) for bounds in some]))
                for group, some in parts.items()
            ),
        }.items():
            object.__setattr__(self, name, value)

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Which of the configurations (...) keep every limit, but for ROUNDING."""
        masks = [group.keeps(ranges, pose, joints) for group, ranges in self.checks]
        for (group, _), limit in zip(self.places, self.limits, strict=True):
            if group is None:
                values = limit.values(pose, joints)
                _, low, high = _widened(slice(0), limit.low, limit.high)
                inside = (values >= low) & (values <= high)
                masks.append(np.asarray(inside.all(axis=-1)))
        if len(masks) == 1:
            return masks[0]
        everything: Mask = np.ones(np.shape(joints)[:-1], dtype=np.bool_)
        return np.asarray(np.logical_and.reduce([everything, *masks]))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The values of all limits at configurations (...), one after the other: (..., k)."""
        tables = {group: group.limited_values(pose, joints) for group, _ in self.checks}
        return np.concatenate(
            [
                limit.values(pose, joints) if group is None else tables[group][..., columns]
                for (group, columns), limit in zip(self.places, self.limits, strict=True)
            ],
            axis=-1,
        )

    @property
    def is_one_group(self) -> bool:
        """Whether one group computes all of the values."""
        return len(self.checks) == 1 and all(group is not None for group, _ in self.places)

    def descended(self, search: Search, start: Pose) -> Pose:
        """From an admitted pose down the distance to another, see `LimitGroup`.

        Raises InvalidInput where the limits are not all of one group.
        """
        if not self.is_one_group:
            raise InvalidInput('the nearest pose is searched within the limits of one platform')
        return self.checks[0][0].descended(search, self.bounds[0], start)

    def stretched_to(self, pose: Pose, joints: Array) -> 'Constraints':
        """These limits for a machine that is beyond some of them: it may not go further out.

        The same ones where one configuration keeps them all.
        """
        if bool(self.admits(pose, joints)):
            return self
        return Constraints(
            tuple(StretchedLimit.around(limit, pose, joints) for limit in self.limits)
        )

    def violations(self, pose: Pose, joints: Array) -> list[Violation]:
        """Everything that one configuration violates, in the order of the limits."""
        values = self.values(pose, joints)
        found = []
        for k in np.flatnonzero(~((values >= self.low) & (values <= self.high))):
            quantity, owner, unit = self.names[k]
            value, low, high = float(values[k]), float(self.low[k]), float(self.high[k])
            found.append(Violation(quantity, unit, owner, value, low, high))
        return found

    def check(self, pose: Pose, joints: Array) -> None:
        """Raises LimitViolated, naming the FEW limits that one configuration violates most.

        Those of one quantity by how far it is beyond, quantities in the order of the limits.
        """
        if bool(self.admits(pose, joints)):
            return
        found = self.violations(pose, joints)
        if not found:  # by the last digit of an angle, which `admits` compares by its cosine
            return
        if len(found) > FEW:
            quantities = [violation.quantity for violation in found]
            found.sort(key=lambda v: (quantities.index(v.quantity), -v.excess))
        worst, more = found[0], found[FEW:]
        texts = [*(str(v) for v in found[:FEW]), *([f'and {len(more)} more'] if more else [])]
        alike = [owner for quantity, owner, _ in self.names if quantity == worst.quantity]
        raise LimitViolated(
            '; '.join(texts),
            worst.quantity,
            worst.value,
            (worst.low, worst.high),
            alike.index(worst.owner) + 1 if worst.owner else None,
        )


def _widened(columns: slice, low: Array, high: Array) -> Bounds:
    """Bounds by which a machine that stands exactly at one may stay there."""
    return columns, low - ROUNDING, high + ROUNDING


def _place(limit: Limit) -> tuple[LimitGroup | None, slice]:
    """Where its values are computed together with others, and which columns they are there."""
    return (limit.group, limit.columns) if isinstance(limit, Grouped) else (None, slice(0))


@dataclass(frozen=True, eq=False)
class StretchedLimit(LimitOf):
    """`inner` with bounds [low, high] (k,) that include the present values."""

    low: Array
    high: Array

    @classmethod
    def around(cls, limit: Limit, pose: Pose, joints: Array) -> 'StretchedLimit':
        """Stretched as far as one configuration needs; NaN values stretch nothing."""
        values = limit.values(pose, joints)
        low = np.where(values < limit.low, values - ROUNDING, limit.low)
        high = np.where(values > limit.high, values + ROUNDING, limit.high)
        return cls(limit, frozen(low), frozen(high))

    def values(self, pose: Pose, joints: Array) -> Array:
        """Those of the limit."""
        return self.inner.values(pose, joints)
