"""s(t) from 0 to 1, from rest to rest, the quickest within bounds on ṡ, s̈ and s⃛; by ruckig."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import ruckig

from manipulator.arrays import Array
from manipulator.errors import Refused

FASTEST = 1e9
"""1/s and so on: bounds of what does not move at all."""


@dataclass(frozen=True, eq=False)
class Profile:
    """A ruckig trajectory of one coordinate."""

    duration: float
    _trajectory: Any

    def at(self, times: Array | float) -> tuple[Array, Array, Array]:
        """s, ṡ and s̈ at each of the times (...), those of the ends before and after."""
        flat = np.clip(np.ravel(times), 0.0, self.duration)
        samples = np.array([self._trajectory.at_time(t)[:3] for t in flat.tolist()])
        s, rate, pull = np.moveaxis(samples.reshape(*np.shape(times), 3), -1, 0)
        return np.clip(s, 0.0, 1.0), rate, pull


def profile_within(bounds: Sequence[float], slowness: float = 1.0) -> Profile:
    """bounds: the most that ṡ, s̈ and s⃛ may be; slowness k ≥ 1 makes it take k times as long."""
    request = ruckig.InputParameter(1)
    request.target_position = [1.0]
    names = ('velocity', 'acceleration', 'jerk')
    for power, (name, bound) in enumerate(zip(names, bounds, strict=True), start=1):
        setattr(request, f'max_{name}', [min(bound, FASTEST) / slowness**power])
    trajectory = ruckig.Trajectory(1)
    result = ruckig.Ruckig(1).calculate(request, trajectory)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise Refused(f'no jerk-limited profile was found ({result.name})')
    return Profile(float(trajectory.duration), trajectory)
