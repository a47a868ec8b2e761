"""Rods of fixed length must join crank and platform: what a leg that does not close lacks."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.pose import Pose


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
