"""Each joint's range of travel."""

from dataclasses import dataclass

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class JointRange:
    """Joint positions within [low, high], (n,) each, in radians or metres."""

    low: Array
    high: Array
    owners: tuple[str, ...]
    quantity: str = 'joint angle'
    unit: str = 'rad'

    def __post_init__(self) -> None:
        """Freezes the bounds."""
        object.__setattr__(self, 'low', frozen(self.low))
        object.__setattr__(self, 'high', frozen(self.high))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The joints themselves."""
        return joints
