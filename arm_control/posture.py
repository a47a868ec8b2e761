"""An arm's Jacobian at one moment, with its singular values (docs/arm-kinematics.md, 8)."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array


@dataclass(frozen=True, eq=False)
class Posture:
    """J = U·Σ·Vᵀ (6, 6), with metres divided by the arm's characteristic length.

    Rows of `right` are the columns of V: turning the joints along one moves the tool along the
    same column of `left`, σ times as fast.
    """

    jacobian: Array
    left: Array
    sigma: Array
    right: Array

    @classmethod
    def of(cls, scaled_jacobian: Array) -> 'Posture':
        """Decomposes one scaled Jacobian."""
        left, sigma, right = np.linalg.svd(scaled_jacobian)
        return cls(scaled_jacobian, left, sigma, right)

    @property
    def sigma_min(self) -> float:
        """How near to singular: the smallest singular value."""
        return float(self.sigma[-1])

    def turning(self, rates: Array) -> Array:
        """The tool's acceleration (6,), scaled, at constant joint rates: J̇·q̇.

        With the columns (v_j, a_j): Σ (Ω_j + Ω_{j−1}) × v_j q̇_j and Σ Ω_{j−1} × a_j q̇_j, where
        Ω_j = Σ_{k≤j} a_k q̇_k is the angular velocity of link j.
        """
        moving = self.jacobian * rates
        links = np.cumsum(moving[3:], axis=1)
        before = links - moving[3:]
        linear = (links + before) @ moving[:3].T
        angular = before @ moving[3:].T
        return np.array([*_cross(linear), *_cross(angular)])

    def damped_rates(self, scaled_twist: Array, onset: float) -> Array:
        """Joint rates (6,), their gain bounded to 1.3/onset: the tool may leave its line."""
        result: Array = (self._gains(onset) * (scaled_twist @ self.left)) @ self.right
        return result

    def damped_unit_rates(self, onset: float) -> Array:
        """Damped joint rates for each unit twist, as the columns of (6, 6)."""
        result: Array = (self.right.T * self._gains(onset)) @ self.left.T
        return result

    def _gains(self, onset: float) -> Array:
        """1/σ down to `onset` ε, below it 4σε² / (ε² + σ²)².

        That is the damped σ / (σ² + λ²) with λ = (ε/2)·(1 − (σ/ε)²), so that value and slope are
        continuous, and nothing is left at σ = 0 (numerical filtering after Maciejewski and Klein,
        Int. J. Robotics Research 7(6), 1988).
        """
        sigma = self.sigma
        damped = 4 * sigma * onset**2 / (onset**2 + sigma**2) ** 2
        return np.where(sigma < onset, damped, 1.0 / np.maximum(sigma, onset))


def _cross(products: Array) -> tuple[float, float, float]:
    """Σ a_j × b_j, from Σ a_j·b_jᵀ (3, 3)."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = products.tolist()
    return yz - zy, zx - xz, xy - yx
