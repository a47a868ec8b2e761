"""The limits that every machine may have: joint ranges and body height."""

from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.limits.limit import LimitGroup
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class JointRange:
    """Joint positions within [low, high], (n,) each, in radians or metres.

    group and columns: see `Grouped`.
    """

    low: Array
    high: Array
    owners: tuple[str, ...]
    quantity: str = 'joint angle'
    unit: str = 'rad'
    group: LimitGroup | None = None
    columns: slice = field(default_factory=lambda: slice(0))

    def __post_init__(self) -> None:
        """Freezes the bounds."""
        object.__setattr__(self, 'low', frozen(self.low))
        object.__setattr__(self, 'high', frozen(self.high))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The joints themselves."""
        return joints


@dataclass(frozen=True, eq=False)
class BodyHeight:
    """The platform's origin at least `minimum` metres above the base frame.

    group and columns: see `Grouped`.
    """

    minimum: float
    quantity: str = 'platform height'
    unit: str = 'm'
    owners: tuple[str, ...] = ('',)
    group: LimitGroup | None = None
    columns: slice = field(default_factory=lambda: slice(0))
    low: Array = field(init=False)
    high: Array = field(init=False)

    def __post_init__(self) -> None:
        """Puts the bound into the arrays that every limit has."""
        object.__setattr__(self, 'low', frozen([self.minimum]))
        object.__setattr__(self, 'high', frozen([np.inf]))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The height z, (..., 1)."""
        return pose.position[..., 2:3]
