"""The one constraint check that ik, trajectories, teleop and workspace maps share.

A limit that a machine is beyond is stretched for the way back.
"""

from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.errors import LimitViolated
from manipulator.limits.limit import Bounds, Grouped, Limit, LimitGroup, LimitOf, Violation
from manipulator.pose import Pose


@dataclass(frozen=True)
class Constraints:
    """All limits of a machine on its configuration (pose and joints together).

    What a group of limits has in common is computed once.
    """

    limits: tuple[Limit, ...]
    low: Array = field(init=False, compare=False, repr=False)
    high: Array = field(init=False, compare=False, repr=False)
    checks: tuple[tuple[LimitGroup, Array], ...] = field(init=False, compare=False, repr=False)
    others: tuple[Limit, ...] = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Puts all bounds in a row, and each group's into the ranges that it checks."""
        low, high = ([getattr(limit, end) for limit in self.limits] for end in ('low', 'high'))
        parts: dict[LimitGroup, list[Bounds]] = {}
        for limit in self.limits:
            group = group_of(limit)
            if group is not None and isinstance(limit, Grouped):
                parts.setdefault(group, []).append((limit.columns, limit.low, limit.high))
        checks = tuple((group, group.ranges(bounds)) for group, bounds in parts.items())
        others = tuple(limit for limit in self.limits if group_of(limit) is None)
        object.__setattr__(self, 'low', frozen(np.concatenate([[], *low])))
        object.__setattr__(self, 'high', frozen(np.concatenate([[], *high])))
        object.__setattr__(self, 'checks', checks)
        object.__setattr__(self, 'others', others)

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Which of the configurations (...) keep every limit."""
        masks = [group.keeps(ranges, pose, joints) for group, ranges in self.checks]
        for limit in self.others:
            values = limit.values(pose, joints)
            inside = (values >= limit.low) & (values <= limit.high)
            masks.append(np.asarray(inside.all(axis=-1)))
        if len(masks) == 1:
            return masks[0]
        everything: Mask = np.ones(np.shape(joints)[:-1], dtype=np.bool_)
        return np.asarray(np.logical_and.reduce([everything, *masks]))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The values of all limits at configurations (...), one after the other: (..., k)."""
        tables = {group: group.limited_values(pose, joints) for group, _ in self.checks}
        parts = []
        for limit in self.limits:
            group = group_of(limit)
            if group is not None and isinstance(limit, Grouped):
                parts.append(tables[group][..., limit.columns])
            else:
                parts.append(limit.values(pose, joints))
        return np.concatenate(parts, axis=-1)

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
        beyond = np.flatnonzero(~((values >= self.low) & (values <= self.high)))
        owners = [(limit, owner) for limit in self.limits for owner in limit.owners]
        found = []
        for k in beyond:
            limit, owner = owners[k]
            value, low, high = float(values[k]), float(self.low[k]), float(self.high[k])
            found.append(Violation(limit.quantity, limit.unit, owner, value, low, high))
        return found

    def check(self, pose: Pose, joints: Array) -> None:
        """Raises LimitViolated, naming all that one configuration violates."""
        if bool(self.admits(pose, joints)):
            return
        found = self.violations(pose, joints)
        if not found:  # by the last digit of an angle, which `admits` compares by its cosine
            return
        worst = found[0]
        digits = ''.join(c for c in worst.owner if c.isdigit())
        raise LimitViolated(
            '; '.join(str(v) for v in found),
            worst.quantity,
            worst.value,
            (worst.low, worst.high),
            int(digits) if digits else None,
        )


def group_of(limit: Limit) -> LimitGroup | None:
    """Where its values are computed together with others."""
    return limit.group if isinstance(limit, Grouped) else None


ROUNDING = 1e-9
"""rad, m or a ratio by which values may differ when the same pose is computed again."""


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
