"""Stepper drives on one motion controller, which takes all joints along one straight line."""

from dataclasses import dataclass

import numpy as np

from bridge.fake.servo import Servos
from manipulator.arrays import Array


@dataclass
class Steppers(Servos):
    """As `Servos`, but slowed by one factor for all joints, as an interpolating controller does.

    Hobby servos hurry to each new pulse on their own: one has arrived while another still runs,
    and in between a tool that should keep its orientation at 250 mm/s is off by nearly a degree.
    Drives that interpolate together do not leave the path.
    """

    def _turned(self, error: Array, reach: float) -> Array:
        largest = float(np.abs(error).max(initial=0.0))
        return error if largest <= reach else error * (reach / largest)
