"""Joint rates for a twist, damped only near singular postures (docs/arm-kinematics.md, 8)."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array


@dataclass(frozen=True, eq=False)
class DampedInverse:
    """J = U·Σ·Vᵀ, with metres divided by the arm's length, and the gain of each direction.

    Above `onset` a direction's gain is 1/σ exactly. Below, it is σ/(σ² + λ²) with
    λ = (onset/2)·(1 − (σ/onset)²): smooth at the onset, at most 1/(0.87·onset), 0 at σ = 0
    (after Maciejewski and Klein, Int. J. Robotics Research 7(6), 1988: numerical filtering).
    """

    left: Array
    right: Array
    sigma: Array
    gains: Array

    @classmethod
    def of(cls, scaled_jacobian: Array, onset: float) -> 'DampedInverse':
        """Decomposes one scaled Jacobian (6, 6)."""
        left, sigma, right = np.linalg.svd(scaled_jacobian)
        smallest = sigma[-1]
        if smallest >= onset:
            gains = 1.0 / sigma
        else:
            nearness = np.maximum(1.0 - (sigma / onset) ** 2, 0.0)
            gains = sigma / (sigma**2 + (0.5 * onset * nearness) ** 2)
        return cls(left, right, sigma, gains)

    @property
    def sigma_min(self) -> float:
        """How near to singular: the smallest singular value."""
        return float(self.sigma[-1])

    def rates(self, scaled_twist: Array) -> Array:
        """Joint rates (6,) for one twist whose metres are divided by the arm's length."""
        result: Array = (self.gains * (scaled_twist @ self.left)) @ self.right
        return result

    def unit_rates(self) -> Array:
        """Joint rates for each unit twist, as the columns of (6, 6)."""
        result: Array = (self.right.T * self.gains) @ self.left.T
        return result
