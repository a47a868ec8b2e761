"""How every limit's margin changes with the pose, by differences."""

from dataclasses import dataclass, replace

import numpy as np

from manipulator.analysis.readings import Readings, displaced, read_limits
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

STEP = 1e-6
"""Of the differences, as part of the characteristic length."""


@dataclass(frozen=True, eq=False)
class Slopes:
    """Readings of one pose, and how its margins change.

    gradients (2k, 6) are per metre in each direction of `metric.offset`, 0 where a margin has
    none; steepness (2k,) is their length, taken on the steeper side of a kink.
    """

    readings: Readings
    gradients: Array
    steepness: Array


def slopes(machine: Machine, pose: Pose, near: Array | None = None) -> Slopes:
    """By differences in all six directions, to one side where the other does not close."""
    step = STEP * machine.kinematics.characteristic_length
    around = np.concatenate([np.zeros((1, 6)), step * np.eye(6), -step * np.eye(6)])
    readings = read_limits(machine, displaced(machine, pose, around), near)
    margins = np.where(np.isfinite(readings.margins), readings.margins, np.nan)
    ahead = (margins[1:7] - margins[0]) / step
    behind = (margins[0] - margins[7:]) / step
    either = np.where(np.isnan(ahead), behind, ahead)
    gradients = np.where(np.isnan(ahead + behind), either, (ahead + behind) / 2)
    steeper = np.fmax(np.abs(ahead), np.abs(behind))
    return Slopes(
        replace(readings, values=readings.values[0]),
        np.nan_to_num(gradients).T,
        np.linalg.norm(np.nan_to_num(steeper), axis=0),
    )
