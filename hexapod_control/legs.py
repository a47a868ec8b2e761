"""Six legs of one kind as the kernel takes them: kernel/legs.h, docs/kinematics.md."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from hexapod_control.geometry import LEGS
from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.pose import Pose

NOWHERE = frozen(np.zeros((LEGS, 3)))
CRANKS, RODS = slice(90, 96), slice(96, 102)
"""Where r and d of each leg stand in struct legs."""


class LegKind(IntEnum):
    """What a joint moves: `leg_kind` of kernel/legs.h."""

    LINEAR = 0
    CRANK = 1
    RAIL = 2


@dataclass(frozen=True, eq=False)
class Legs:
    """Six legs; numbers are the struct legs of kernel/legs.h. Joints in radians or metres."""

    numbers: Array

    @classmethod
    def of(
        cls,
        kind: LegKind,
        centres: Array,
        platform_points: Array,
        *,
        axes: tuple[Array, Array, Array] = (NOWHERE, NOWHERE, NOWHERE),
        cranks: ArrayLike = 1.0,
        rods: ArrayLike = 0.0,
        middles: ArrayLike = 0.0,
        screws: tuple[float, Array, Array] = (0.0, NOWHERE, NOWHERE),
    ) -> 'Legs':
        """From points and axes (6, 3), the latter normals, tangents and ups; lengths in metres.

        screws are the lead (m) and the axes fixed to the cardan joints on base and platform.
        """
        lead, *cardans = screws
        points = (centres, *axes, platform_points)
        six = (np.broadcast_to(values, LEGS) for values in (cranks, rods, middles))
        numbers = [*(p.T.ravel() for p in points), *six, [kind, lead]]
        return cls(frozen(np.concatenate([*numbers, *(cardan.T.ravel() for cardan in cardans)])))

    @property
    def rods(self) -> Array:
        """The rods' own lengths, (6,) metres."""
        return self.numbers[RODS]

    @property
    def most_gains(self) -> Array:
        """The largest |gain| that each joint can have, (6,) m/rad or m/m."""
        return np.abs(self.numbers[CRANKS])

    def branches(self, pose: Pose) -> tuple[Array, Array]:
        """The joints (6,) of one pose, as at home and the other way; NaN where a leg is open."""
        home, other = np.empty(LEGS), np.empty(LEGS)
        _kernel.leg_branches(self.numbers, pose.position, pose.rotation, home, other)
        return home, other

    def base_points(self, joints: Array) -> Array:
        """Where the rods begin, (..., 6, 3), base frame, metres; NaN for NaN joints."""
        given = stretched(joints, (*np.shape(joints)[:-1], LEGS))
        points = np.empty((*given.shape, 3))
        _kernel.leg_points(self.numbers, given, points)
        return points

    def screw_turns(self, pose: Pose) -> tuple[Array, Array]:
        """What screws add to the joints of linear legs (..., 6) m, and its rows (..., 6, 6).

        The latter for a unit twist, as those of the leg Jacobian.
        """
        extra, rows = (np.empty((*pose.position.shape[:-1], *n)) for n in ((LEGS,), (LEGS, 6)))
        _kernel.screw_turns(self.numbers, pose.position, pose.rotation, extra, rows)
        return extra, rows

    def gains(self, joints: Array, directions: Array) -> Array:
        """How fast base points go along unit vectors (..., 6, 3), per joint: (..., 6).

        1 for linear legs, whose base points stand still while the rod grows.
        """
        along = stretched(directions, (*np.shape(directions)[:-2], LEGS, 3))
        gains = np.empty(along.shape[:-1])
        _kernel.leg_gains(self.numbers, stretched(joints, gains.shape), along, gains)
        return gains
