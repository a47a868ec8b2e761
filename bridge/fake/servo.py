"""What a fake board's pulses move: hobby servos, steppers, or a simulation of the whole machine.

A hobby servo has a dead band, a limited speed and play in its gears.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from manipulator.arrays import Array


@dataclass
class Servos:
    """All servos of a machine; positions in rad (or m), shape (n,).

    motor is where the motor stands, before the gears; `positions` is the output, which follows
    within half of `hysteresis` (a play operator: an output stays until its motor has crossed the
    play). The motor rests while its error is below half of `dead_band`.
    """

    speed: float
    dead_band: Array
    hysteresis: Array
    motor: Array
    positions: Array

    @classmethod
    def at_rest(
        cls, start: ArrayLike, speed: float, dead_band: ArrayLike, hysteresis: ArrayLike
    ) -> 'Servos':
        """Unpowered servos at `start`; speed in rad/s (or m/s), the rest in rad (or m)."""
        motor = np.array(start, dtype=np.float64)
        widths = (np.broadcast_to(np.asarray(w), motor.shape) for w in (dead_band, hysteresis))
        dead, play = (np.array(width, dtype=np.float64) for width in widths)
        return cls(speed, dead, play, motor, motor.copy())

    def step(self, targets: Array, dt: float) -> None:
        """Follows `targets` for `dt` seconds; NaN means no pulse: that servo stays."""
        error = targets - self.motor
        is_moving = np.abs(error) > self.dead_band / 2
        self.motor = self.motor + self._turned(np.where(is_moving, error, 0.0), self.speed * dt)
        half = self.hysteresis / 2
        self.positions = np.clip(self.positions, self.motor - half, self.motor + half)

    def _turned(self, error: Array, reach: float) -> Array:
        """How far the motors come, of `error` (n,); each at its own full speed."""
        turned: Array = np.clip(error, -reach, reach)
        return turned


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
