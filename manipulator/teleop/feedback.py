"""How hard a held orientation or point is pulled back to its reference."""

import math
from dataclasses import dataclass

from manipulator.arrays import Array
from manipulator.errors import InvalidInput

GAIN_TIMES_DELAY = 0.3
"""K·delay of a loop that neither rings nor diverges: it is critically damped at 1/e = 0.37."""
MAX_GAIN = 10.0
"""1/s, however short the delay."""


@dataclass(frozen=True)
class Feedback:
    """velocity = gain · error, bounded: gain in 1/s, the bounds in m/s and rad/s.

    The bounds let a mode that begins far from its reference approach it gently.
    """

    gain: float
    linear_bound: float = 0.05
    angular_bound: float = 0.5

    def __post_init__(self) -> None:
        """Raises InvalidInput for gains and bounds that are not positive."""
        for name in ('gain', 'linear_bound', 'angular_bound'):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InvalidInput(f'{name} is {value}, needs a positive number')

    @classmethod
    def for_delay(cls, delay: float) -> 'Feedback':
        """With the gain that a delay of so many seconds, measurement to motion, allows.

        Raises InvalidInput for a delay that is negative or not finite.
        """
        if not 0 <= delay < math.inf:
            raise InvalidInput(f'delay is {delay} s, needs a number from 0 up')
        return cls(min(MAX_GAIN, GAIN_TIMES_DELAY / max(delay, 1e-9)))

    def linear(self, error: Array) -> Array:
        """Velocity (3,) in m/s towards a point that is `error` metres away."""
        return _bounded(self.gain * error, self.linear_bound)

    def angular(self, error: Array) -> Array:
        """Angular velocity (3,) in rad/s towards an orientation, `error` a rotation vector."""
        return _bounded(self.gain * error, self.angular_bound)


def _bounded(velocity: Array, bound: float) -> Array:
    speed = math.hypot(*velocity.tolist())
    return velocity if speed <= bound else velocity * (bound / speed)
