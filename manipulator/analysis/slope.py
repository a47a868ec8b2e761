"""How every limit's margin changes with the pose, and the nearest point within linear limits."""

from dataclasses import dataclass, replace

import numpy as np

from manipulator import _kernel
from manipulator.analysis.readings import Readings, displaced, read_limits
from manipulator.arrays import Array, stretched
from manipulator.machine import Machine
from manipulator.pose import Pose


def nearest_point(target: Array, normals: Array, slack: Array) -> tuple[Array, Array]:
    """The y nearest to `target` (6,) with normals·y + slack ≥ 0, and its multipliers (m,).

    y − target = normalsᵀ·multipliers. Least distance programming, chapter 23. Where no y does,
    or none is found, y is `target` and the multipliers are NaN.
    """
    rows, bounds = stretched(normals, (len(slack), 6)), stretched(slack, np.shape(slack))
    weights = np.empty(len(bounds))
    if not _kernel.least_distance(stretched(target, (6,)), rows, bounds, weights):
        return target, np.full(len(bounds), np.nan)
    return target + weights @ rows, weights


STEP = 1e-6
"""Of the differences, as part of the characteristic length."""
AROUND = STEP * np.concatenate([np.zeros((1, 6)), np.eye(6), -np.eye(6)])


@dataclass(frozen=True, eq=False)
class Slopes:
    """Readings of one pose, and how its margins change.

    gradients (2k, 6) are per metre in each direction of `readings.offset`, 0 where a margin has
    none; steepness (2k,) is their length, taken on the steeper side of a kink.
    """

    readings: Readings
    gradients: Array
    steepness: Array


def slopes(machine: Machine, pose: Pose, near: Array | None = None) -> Slopes:
    """By differences in all six directions, to one side where the other does not close."""
    length = machine.kinematics.characteristic_length
    readings = read_limits(machine, displaced(machine, pose, length * AROUND), near)
    margins = readings.margins
    with np.errstate(invalid='ignore'):  # without a bound, the difference of two infinities
        sides = np.stack([margins[1:7] - margins[0], margins[0] - margins[7:]]) / (STEP * length)
    sides = np.where(np.isfinite(sides), sides, sides[::-1])
    sides[~np.isfinite(sides)] = 0.0
    steeper = np.abs(sides).max(axis=0)
    return Slopes(
        replace(readings, values=readings.values[0]),
        ((sides[0] + sides[1]) / 2).T,
        np.sqrt((steeper * steeper).sum(axis=0)),
    )
