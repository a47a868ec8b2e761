"""Joint rates for a twist, damped only near singular postures (docs/arm-kinematics.md, 8)."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array


@dataclass(frozen=True, eq=False)
class DampedInverse:
    """J = U·Σ·Vᵀ, with metres divided by the arm's length, and the gain of each direction.

    Down to `onset` ε a direction's gain is 1/σ exactly, below it 4σε² / (ε² + σ²)²: the damped
    σ / (σ² + λ²) with λ = (ε/2)·(1 − (σ/ε)²), so that value and slope are continuous. No gain
    exceeds 1.3/ε, and none is left at σ = 0 (numerical filtering after Maciejewski and Klein,
    Int. J. Robotics Research 7(6), 1988).
    """

    left: Array
    right: Array
    sigma: Array
    gains: Array

    @classmethod
    def of(cls, scaled_jacobian: Array, onset: float) -> 'DampedInverse':
        """Decomposes one scaled Jacobian (6, 6)."""
        left, sigma, right = np.linalg.svd(scaled_jacobian)
        if sigma[-1] >= onset:
            gains = 1.0 / sigma
        else:
            damped = 4 * sigma * onset**2 / (onset**2 + sigma**2) ** 2
            gains = np.where(sigma < onset, damped, 1.0 / np.maximum(sigma, onset))
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
