"""The Euler angles of Lapikov et al. 2014: R = Rz(α)·Rx(β)·Rz(γ)."""

import numpy as np
from numpy.typing import ArrayLike

from manipulator.arrays import Array

LEAST_SINE = 1e-6


def from_zxz(angles: ArrayLike) -> Array:
    """The rotation matrix of α, β, γ in radians; (..., 3) to (..., 3, 3): section 4."""
    values = np.asarray(angles, dtype=np.float64)
    (sa, sb, sg), (ca, cb, cg) = (np.moveaxis(f(values), -1, 0) for f in (np.sin, np.cos))
    rows = [
        [ca * cg - sa * cb * sg, -ca * sg - sa * cb * cg, sa * sb],
        [sa * cg + ca * cb * sg, -sa * sg + ca * cb * cg, -ca * sb],
        [sb * sg, sb * cg, cb],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def to_zxz(rotation: ArrayLike) -> Array:
    """α, β, γ of rotation matrices (..., 3, 3) with β in [0, π], in radians: (..., 3).

    Only α + γ (or α − γ) is fixed where sin β = 0: for sin β < 1e-6, γ is 0.
    """
    m = np.asarray(rotation, dtype=np.float64)
    sine = np.hypot(m[..., 0, 2], m[..., 1, 2])
    level = sine < LEAST_SINE
    alpha = np.where(
        level, np.arctan2(m[..., 1, 0], m[..., 0, 0]), np.arctan2(m[..., 0, 2], -m[..., 1, 2])
    )
    gamma = np.where(level, 0.0, np.arctan2(m[..., 2, 0], m[..., 2, 1]))
    return np.stack([alpha, np.arctan2(sine, m[..., 2, 2]), gamma], axis=-1)
