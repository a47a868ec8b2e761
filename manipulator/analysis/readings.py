"""Every limit's reading at a pose: value, range, margin, and how far away the limit is.

Distances between poses are metres; rotations become lengths by the characteristic length.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.limits.limit import Violation
from manipulator.machine import Machine
from manipulator.pose import Pose

CHECKS_PER_LENGTH = 70
"""How closely a path is checked: as the walkers of the workspace are."""


def scale(machine: Machine) -> Array:
    """(6,): a twist times it is in metres."""
    return np.array([1.0] * 3 + [machine.kinematics.characteristic_length] * 3)


def offset(machine: Machine, start: Pose, end: Pose) -> Array:
    """The twist from start to end in metres (..., 6)."""
    result: Array = start.twist_to(end) * scale(machine)
    return result


def distance(machine: Machine, start: Pose, end: Pose) -> Array:
    """√(|Δp|² + L²·angle²) in metres (...), L the characteristic length."""
    step = offset(machine, start, end)
    result: Array = np.sqrt((step * step).sum(axis=-1))
    return result


def displaced(machine: Machine, pose: Pose, step: Array) -> Pose:
    """The pose moved by a step (..., 6) in metres."""
    return pose.moved(step / scale(machine))


@dataclass(frozen=True)
class LimitReading(Violation):
    """One limited value at one pose.

    distance is about how far the pose is from the limit, in metres (rotations scaled by the
    characteristic length): margin by slope, negative outside, ∞ where the value does not change.
    """

    distance: float

    @property
    def margin(self) -> float:
        """How far inside its range the value is, in the limit's unit; negative outside."""
        return -self.excess


@dataclass(frozen=True, eq=False)
class Readings:
    """Limited values (..., k) at poses (...), NaN where there is none, and what they are.

    names are (quantity, owner, unit); low and high (k,) the ranges.
    """

    names: tuple[tuple[str, str, str], ...]
    values: Array
    low: Array
    high: Array

    @property
    def margins(self) -> Array:
        """From below, then from above: (..., 2k), ∞ where there is no bound."""
        return np.concatenate([self.values - self.low, self.high - self.values], axis=-1)


def read_limits(machine: Machine, pose: Pose, near: Array | None = None) -> Readings:
    """All limits at poses (...), joints on the branch nearest to `near` (default: home's)."""
    return readings_of(machine, pose, machine.kinematics.inverse_or_nan(pose, near))


def readings_of(machine: Machine, pose: Pose, joints: Array) -> Readings:
    """All limits at poses (...) with their joints (..., n), NaN where they do not close."""
    limits = machine.constraints
    return Readings(limits.names, limits.values(pose, joints), limits.low, limits.high)
