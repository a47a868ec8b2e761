"""How far a machine goes from home along and about each axis, and its smallest margins there."""

from dataclasses import dataclass

import numpy as np

from manipulator.analysis.reach import readings
from manipulator.analysis.readings import LimitReading
from manipulator.analysis.travel import travel
from manipulator.machine import Machine

AXES = ('x', 'y', 'z', 'roll', 'pitch', 'yaw')
MARGINS = 3


@dataclass(frozen=True)
class AxisReach:
    """From home along an axis of the base, or about it: low ≤ 0 ≤ high in m or rad."""

    axis: str
    unit: str
    low: float
    high: float


def reach_from_home(machine: Machine) -> tuple[AxisReach, ...]:
    """Of all six axes; turns end at half a turn. Empty where home itself is beyond a limit."""
    home = machine.kinematics.home
    if not bool(machine.constraints.admits(home, machine.kinematics.inverse(home))):
        return ()
    ways = [
        [travel(machine, home, sign * twist).seconds for sign in (-1.0, 1.0)]
        for twist in np.eye(6)
    ]
    return tuple(
        AxisReach(axis, 'm' if k < 3 else 'rad', -ways[k][0] + 0.0, ways[k][1])
        for k, axis in enumerate(AXES)
    )


def smallest_margins(machine: Machine) -> tuple[LimitReading, ...]:
    """The nearest reading at home of each limited quantity, the three nearest ones."""
    nearest: dict[str, LimitReading] = {}
    for reading in readings(machine, machine.kinematics.home):
        nearest.setdefault(reading.quantity, reading)
    return tuple(nearest.values())[:MARGINS]
