"""A plan: a motion in its own time, made and checked before it begins."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class MotionState:
    """Pose, twist (..., 6) and its time derivative (..., 6), base axes, at one or many times."""

    pose: Pose
    twist: Array
    acceleration: Array

    @classmethod
    def at_rest(cls, pose: Pose) -> 'MotionState':
        """At rest at one pose."""
        return cls(pose, frozen(np.zeros(6)), frozen(np.zeros(6)))

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves, to a micrometre and a microradian a second."""
        return bool(np.abs(self.twist).max() < 1e-6)


Ends = tuple[Array, Array, Array]
"""Coordinates (..., n) with two derivatives."""


class CoordinateCurve(Protocol):
    """Coordinates over time: joints, or the local coordinates of poses."""

    @property
    def duration(self) -> float:
        """Seconds."""
        ...

    def at(self, times: Array | float) -> Ends:
        """Values and two derivatives (..., n) at each of the times (...), the ends' outside."""
        ...


class Plan(Protocol):
    """A motion from time 0 to `duration` (∞ for one that goes on until it is stopped)."""

    @property
    def duration(self) -> float:
        """Seconds of the plan's own time."""
        ...

    @property
    def checked_duration(self) -> float:
        """Seconds to check: the duration, unless a plan differs, as a cycle by its period."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...), the end state after the end."""
        ...

    def joints_at(self, times: Array | float) -> Array | None:
        """The joints (..., n) at each of the times; None, unless a plan has them.

        Without them they follow from the poses, on the branch that the machine is on.
        """
        return None

    def joints_along(self, kinematics: Kinematics, times: Array, near: Array) -> Array:
        """The joints (k, n) at times (k,) in a row: its own, else those of its poses from `near`.

        NaN where the inverse ends: see `Kinematics.inverse_along`.
        """
        own = self.joints_at(times)
        return kinematics.inverse_along(self.at(times).pose, near) if own is None else own

    def where(self, time: float) -> str:
        """The place at a time, in words that follow what happens there: 'at 62 % of the line'."""
        ...


@dataclass(frozen=True, eq=False)
class Hold(Plan):
    """Rest at one pose."""

    pose: Pose
    duration: float = 0.0

    def at(self, times: Array | float) -> MotionState:
        """The pose at rest, once for each time."""
        shape = np.shape(times)
        pose = Pose(
            np.broadcast_to(self.pose.position, (*shape, 3)),
            np.broadcast_to(self.pose.rotation, (*shape, 3, 3)),
        )
        return MotionState(pose, np.zeros((*shape, 6)), np.zeros((*shape, 6)))

    def where(self, time: float) -> str:
        """See `Plan`."""
        return 'at the current pose'
