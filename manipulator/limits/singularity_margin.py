"""Distance from the poses that the joints do not fix."""

from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose


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
