"""Newton's method of the kernel on legs of any lengths, without a machine around them."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.forward import rules, solution
from manipulator import _kernel
from manipulator.arrays import stretched


def lengths_at(base, platform, pose):
    """The rods' lengths (6,) from base points to platform points (6, 3 each)."""
    return np.linalg.norm(pose.transform(platform) - base, axis=1)


@dataclass(frozen=True, eq=False)
class Newton:
    """Rods to platform_points (6, 3); characteristic_length (m) scales rotations in σmin."""

    platform_points: np.ndarray
    characteristic_length: float

    def solve(self, base_points, lengths, start, side=None, margin=0.0):
        """From `start`; side: the sign that det J must have; margin: the least σmin."""
        position, rotation, report = np.empty(3), np.empty((3, 3)), np.empty(5)
        _kernel.forward_by_lengths(
            stretched(self.platform_points, (6, 3)),
            rules(self.characteristic_length, side, margin),
            stretched(base_points, (6, 3)),
            stretched(lengths, (6,)),
            start.position,
            start.rotation,
            position,
            rotation,
            report,
        )
        return solution(position, rotation, report, margin)
