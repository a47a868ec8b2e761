"""The limits of machines: joint ranges, body height, distance from singular poses, rod closure."""

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.kinematics import Kinematics
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
        """Which configurations (...) keep the margin; by a quick test where there are many."""
        if joints.ndim == 2 and len(joints) >= MANY and isinstance(self.kinematics, KeepsMargin):
            return self.kinematics.keeps_margin(pose, joints, self.minimum)
        return np.asarray(self.kinematics.sigma_min(pose, joints) >= self.minimum, dtype=np.bool_)


class RodSpans(Protocol):
    """Rods and the spans they must bridge, in metres: docs/kinematics.md, (2.3)."""

    def rod_misfit(self, pose: Pose) -> tuple[Array, Array]:
        """(..., legs) each: shortest rod that would do − rod, and rod − longest that would."""
        ...


@dataclass(frozen=True, eq=False)
class RodClosure:
    """How much too short (or too long) each rod is to close its leg, in metres: at most 0.

    Depends on the pose alone and so has a value where the joints have none.
    """

    spans: RodSpans
    owners: tuple[str, ...]
    is_surplus: bool = False
    unit: str = 'm'
    low: Array = field(init=False)
    high: Array = field(init=False)

    def __post_init__(self) -> None:
        """Puts the bound into the arrays that every limit has."""
        object.__setattr__(self, 'low', frozen(np.full(len(self.owners), -np.inf)))
        object.__setattr__(self, 'high', frozen(np.zeros(len(self.owners))))

    @property
    def quantity(self) -> str:
        """What is lacking."""
        return 'rod surplus' if self.is_surplus else 'rod shortfall'

    def values(self, pose: Pose, joints: Array) -> Array:
        """Shortfall or surplus (..., legs), negative where the leg closes."""
        return self.spans.rod_misfit(pose)[int(self.is_surplus)]

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Whether the joints exist: that is when every leg closes."""
        return np.asarray(np.isfinite(joints).all(axis=-1), dtype=np.bool_)
