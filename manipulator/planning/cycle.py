"""Periodic motion: on each axis a sum of sines, as in the experiment of Prokopovich 2019."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, inf, lcm

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.planning.plan import MotionState, Plan
from manipulator.pose import Pose

LONGEST_PERIOD = 60.0
FREQUENCY_STEP = 1000
"""Frequencies are rounded to a thousandth of a hertz, so that a common period exists."""


@dataclass(frozen=True, eq=False)
class Cycle(Plan):
    """x(t) = Σ A sin(2π f t + φ) on x, y, z, roll, pitch and yaw about the centre pose.

    amplitude, frequency and phase are (terms, 6) or (6,): metres and radians, hertz, radians.
    Position adds to the centre's, the orientation is Rz(yaw)·Ry(pitch)·Rx(roll)·R_centre. Raises
    InvalidInput for shapes that do not fit, negative frequencies, and frequencies whose common
    period is above 60 s: a motion that never repeats cannot be checked before it starts.
    """

    centre: Pose
    amplitude: Array
    frequency: Array
    phase: Array
    duration: float = inf

    def __post_init__(self) -> None:
        """Checks and freezes the terms."""
        for name in ('amplitude', 'frequency', 'phase'):
            value = frozen(np.atleast_2d(getattr(self, name)))
            if value.ndim != 2 or value.shape[1] != 6 or not np.isfinite(value).all():
                raise InvalidInput(f'cycle {name}: needs six finite numbers a term')
            object.__setattr__(self, name, value)
        if not self.amplitude.shape == self.frequency.shape == self.phase.shape:
            raise InvalidInput('cycle: amplitude, frequency and phase differ in their terms')
        if (self.frequency < 0).any() or (self.frequency > 25).any():
            raise InvalidInput(f'cycle frequency {self.frequency.tolist()} outside [0, 25] Hz')
        if self.checked_duration > LONGEST_PERIOD:
            raise InvalidInput(
                f'cycle frequencies have a common period of {self.checked_duration:.4g} s, '
                f'at most {LONGEST_PERIOD:g} s'
            )

    @property
    def checked_duration(self) -> float:
        """The common period of all axes that move; 0 where none does."""
        moving = self.frequency[(self.amplitude != 0) & (self.frequency > 0)]
        steps = [round(f * FREQUENCY_STEP) for f in moving.tolist()]
        fractions = [Fraction(FREQUENCY_STEP, s) for s in steps if s]
        if not fractions:
            return 0.0
        top = lcm(*(f.numerator for f in fractions))
        return top / gcd(*(f.denominator for f in fractions))

    def at(self, times: Array | float) -> MotionState:
        """The state at each time (...)."""
        t = np.asarray(times, dtype=np.float64)
        x, v, a = self._offsets(t)
        turn = so3.from_rpy(x[..., 3:])
        pose = Pose(self.centre.position + x[..., :3], turn @ self.centre.rotation)
        v[..., 3:], a[..., 3:] = _turning(x[..., 3:], v[..., 3:], a[..., 3:])
        return MotionState(pose, v, a)

    def where(self, time: float) -> str:
        """See `Plan`."""
        return f'{time:.2f} s into the cycle'

    @cached_property
    def _rate(self) -> Array:
        """2π f (terms, 6), rad/s."""
        return 2 * np.pi * np.round(self.frequency * FREQUENCY_STEP) / FREQUENCY_STEP

    def _offsets(self, t: Array) -> tuple[Array, Array, Array]:
        rate = self._rate
        angle = rate * t[..., None, None] + self.phase
        sine, cosine = self.amplitude * np.sin(angle), self.amplitude * np.cos(angle)
        return sine.sum(-2), (rate * cosine).sum(-2), (-(rate**2) * sine).sum(-2)


def _turning(rpy: Array, rates: Array, pulls: Array) -> tuple[Array, Array]:
    """ω and its derivative in fixed axes of Rz(y)·Ry(p)·Rx(r), by the derivatives of r, p, y."""
    (_, sp, sy), (_, cp, cy) = np.sin(rpy).T, np.cos(rpy).T
    (r1, p1, y1), (r2, p2, y2) = rates.T, pulls.T
    along, across = cp * r1, cp * r2 - sp * p1 * r1 - p1 * y1
    omega = [cy * along - sy * p1, sy * along + cy * p1, y1 - sp * r1]
    turned = p2 + along * y1
    alpha = [cy * across - sy * turned, sy * across + cy * turned, y2 - sp * r2 - cp * p1 * r1]
    return np.array(omega).T, np.array(alpha).T
