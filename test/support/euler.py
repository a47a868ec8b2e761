"""Rotation matrices of the Euler angles of Lapikov et al. 2014: R = Rz(α)·Rx(β)·Rz(γ)."""

import numpy as np

from manipulator import rotation as so3


def from_zxz(angles):
    """Of α, β, γ in radians, (..., 3) to (..., 3, 3)."""
    about_z = np.asarray(angles)[..., None] * [0.0, 0.0, 1.0]
    about_x = np.asarray(angles)[..., None] * [1.0, 0.0, 0.0]
    first, last = so3.exp(about_z[..., 0, :]), so3.exp(about_z[..., 2, :])
    return first @ so3.exp(about_x[..., 1, :]) @ last
