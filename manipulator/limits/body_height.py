"""The platform must stay above the body's lid."""

from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class BodyHeight:
    """The platform's origin at least `minimum` metres above the base frame."""

    minimum: float
    quantity: str = 'platform height'
    unit: str = 'm'
    owners: tuple[str, ...] = ('',)
    low: Array = field(init=False)
    high: Array = field(init=False)

    def __post_init__(self) -> None:
        """Puts the bound into the arrays that every limit has."""
        object.__setattr__(self, 'low', frozen([self.minimum]))
        object.__setattr__(self, 'high', frozen([np.inf]))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The height z, (..., 1)."""
        return pose.position[..., 2:3]
