"""The one constraint check that ik, trajectories, teleop and workspace maps share.

A limit that a machine is beyond is stretched for the way back.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.errors import LimitViolated
from manipulator.limits.limit import Limit, LimitOf, Violation, admitted
from manipulator.pose import Pose


@dataclass(frozen=True)
class Constraints:
    """All limits of a machine on its configuration (pose and joints together)."""

    limits: tuple[Limit, ...]

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Which of the configurations (...) keep every limit."""
        inside: Mask = np.ones(np.shape(joints)[:-1], dtype=np.bool_)
        for limit in self.limits:
            inside &= admitted(limit, pose, joints)
        return inside

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
        found = []
        for limit in self.limits:
            values = limit.values(pose, joints)
            for k in np.flatnonzero(~((values >= limit.low) & (values <= limit.high))):
                value, low, high = float(values[k]), float(limit.low[k]), float(limit.high[k])
                owner = limit.owners[k]
                found.append(Violation(limit.quantity, limit.unit, owner, value, low, high))
        return found

    def check(self, pose: Pose, joints: Array) -> None:
        """Raises LimitViolated, naming all that one configuration violates."""
        if bool(self.admits(pose, joints)):
            return
        found = self.violations(pose, joints)
        worst = found[0]
        digits = ''.join(c for c in worst.owner if c.isdigit())
        raise LimitViolated(
            '; '.join(str(v) for v in found),
            worst.quantity,
            worst.value,
            (worst.low, worst.high),
            int(digits) if digits else None,
        )


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
