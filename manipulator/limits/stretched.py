"""A limit that a machine stands beyond, for the way back."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.limits.limit import Limit
from manipulator.limits.limit_of import LimitOf
from manipulator.pose import Pose

ROUNDING = 1e-9
"""rad, m or a ratio by which values may differ when the same place is worked out again."""


@dataclass(frozen=True, eq=False)
class StretchedLimit(LimitOf):
    """`inner` with bounds [low, high] (k,) that take in where the machine stands."""

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
