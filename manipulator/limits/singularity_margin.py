"""Distance from the poses that the joints do not fix."""

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

MANY = 64


@runtime_checkable
class KeepsMargin(Protocol):
    """A kinematics that compares σmin of many configurations without computing it."""

    def keeps_margin(self, pose: Pose, joints: Array, minimum: float) -> Mask:
        """Which of N configurations have σmin above `minimum`."""
        ...


@dataclass(frozen=True, eq=False)
class SingularityMargin:
    """The kinematics' σmin at least `minimum` (dimensionless)."""

    kinematics: Kinematics
    minimum: float
    quantity: str = 'singularity margin'
    unit: str = ''
    owners: tuple[str, ...] = ('',)
    low: Array = field(init=False)
    high: Array = field(init=False)

    def __post_init__(self) -> None:
        """Puts the bound into the arrays that every limit has."""
        object.__setattr__(self, 'low', frozen([self.minimum]))
        object.__setattr__(self, 'high', frozen([np.inf]))

    def values(self, pose: Pose, joints: Array) -> Array:
        """σmin, (..., 1); NaN joints give NaN."""
        return self.kinematics.sigma_min(pose, joints)[..., None]

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Which configurations (...) keep the margin; the quick way where there are many."""
        if joints.ndim == 2 and len(joints) >= MANY and isinstance(self.kinematics, KeepsMargin):
            return self.kinematics.keeps_margin(pose, joints, self.minimum)
        return np.asarray(self.kinematics.sigma_min(pose, joints) >= self.minimum, dtype=np.bool_)
