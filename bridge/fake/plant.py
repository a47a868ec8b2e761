"""What a fake board's pulses move: the servo model, or a simulation of the whole machine."""

from typing import Protocol

from manipulator.arrays import Array

PLANTS = SERVO, MUJOCO = 'servo', 'mujoco'
"""By name: each servo by itself, or the machine as rigid bodies."""


class Plant(Protocol):
    """Positions in rad (or m), one a servo, in the calibration's order."""

    @property
    def positions(self) -> Array:
        """Where the outputs are."""
        ...

    def step(self, targets: Array, dt: float) -> None:
        """Goes on for dt seconds towards targets; NaN means no pulse."""
        ...
