"""Rotations as matrices: quaternions, roll-pitch-yaw, and the exponential map of SO(3).

All functions broadcast over leading axes. Quaternions are x, y, z, w as in ROS.
"""

import numpy as np
from numpy.typing import ArrayLike

from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.errors import InvalidInput

UNIT_TOLERANCE = 1e-3


def skew(vector: Array) -> Array:
    """The matrix whose product with x is `vector` × x; (..., 3) to (..., 3, 3)."""
    matrix = np.zeros((*vector.shape, 3))
    matrix[..., 2, 1] = vector[..., 0]
    matrix[..., 0, 2] = vector[..., 1]
    matrix[..., 1, 0] = vector[..., 2]
    matrix[..., 1, 2] = -vector[..., 0]
    matrix[..., 2, 0] = -vector[..., 1]
    matrix[..., 0, 1] = -vector[..., 2]
    return matrix


def _products() -> Array:
    """E (16, 9), flat 3×3 matrices with R = Σ qᵢ qⱼ Eᵢⱼ for a unit quaternion q = x, y, z, w."""
    basis, table = np.eye(3), np.zeros((4, 4, 3, 3))
    for i, j in np.ndindex(3, 3):
        outer = np.outer(basis[i], basis[j])
        table[i, j] = outer + outer.T - basis * basis[i, j]
    table[:3, 3] = table[3, :3] = skew(basis)
    table[3, 3] = basis
    return frozen(table.reshape(16, 9))


PRODUCTS = _products()


def exp(rotation_vector: ArrayLike) -> Array:
    """Rodrigues' formula: the rotation by |w| about w; (..., 3) to (..., 3, 3)."""
    w = _shaped(rotation_vector, (3,))
    matrix = np.empty((*w.shape, 3))
    _kernel.rotation_exp(w, matrix)
    return matrix


def log(rotation: ArrayLike) -> Array:
    """The rotation vector of a matrix, |w| ≤ π; (..., 3, 3) to (..., 3)."""
    matrix = _shaped(rotation, (3, 3))
    w = np.empty(matrix.shape[:-1])
    _kernel.rotation_log(matrix, w)
    return w


def _shaped(values: ArrayLike, shape: tuple[int, ...]) -> Array:
    """As the kernel takes them; InvalidInput unless the last axes have that shape."""
    array = np.asarray(values, dtype=np.float64)
    if array.shape[-len(shape) :] != shape:
        raise InvalidInput(f'an array of shape {array.shape}, needs (..., {str(shape)[1:-1]})')
    return stretched(array, array.shape)


def left_jacobian(rotation_vector: ArrayLike) -> Array:
    """J with ω = J(w) ẇ, where ω is the angular velocity in the fixed frame of exp(w)."""
    w = np.asarray(rotation_vector, dtype=np.float64)
    angle = np.sqrt(np.einsum('...i,...i->...', w, w))[..., None, None]
    safe = np.maximum(angle, 1e-4)
    small = angle < 1e-4
    first = np.where(small, 0.5 - angle**2 / 24, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(small, 1 / 6 - angle**2 / 120, (safe - np.sin(safe)) / safe**3)
    k = skew(w)
    matrix: Array = np.eye(3) + first * k + second * (k @ k)
    return matrix


def from_quaternion(quaternion: ArrayLike) -> Array:
    """The matrix of a unit quaternion x, y, z, w.

    Lengths within 0.1 % of one are normalised; any other raises InvalidInput.
    """
    q = np.asarray(quaternion, dtype=np.float64)
    length = np.sqrt(np.einsum('...i,...i->...', q, q))
    if not np.all(np.abs(length - 1.0) <= UNIT_TOLERANCE):
        worst = np.ravel(length)[np.argmax(np.abs(np.nan_to_num(np.ravel(length), nan=9.9) - 1))]
        raise InvalidInput(f'quaternion has length {worst:.6g}, a rotation needs 1 ± 0.001')
    unit = q / length[..., None]
    outer = unit[..., :, None] * unit[..., None, :]
    matrix: Array = (outer.reshape(*q.shape[:-1], 16) @ PRODUCTS).reshape(*q.shape[:-1], 3, 3)
    return matrix


def to_quaternion(rotation: ArrayLike) -> Array:
    """The unit quaternion x, y, z, w with w ≥ 0; (..., 3, 3) to (..., 4).

    Every row of 4·q·qᵀ = I + (⟨Eᵢⱼ, R⟩) is the quaternion times a factor; the longest is taken.
    """
    m = np.asarray(rotation, dtype=np.float64)
    leading = m.shape[:-2]
    rows = (m.reshape(*leading, 9) @ PRODUCTS.T).reshape(-1, 4, 4) + np.eye(4)
    longest = rows.reshape(-1, 16)[:, ::5].argmax(axis=-1)
    q = rows[np.arange(len(rows)), longest]
    q *= np.copysign(1.0, q[:, 3:]) / np.sqrt((q * q).sum(axis=-1))[:, None]
    quaternion: Array = q.reshape(*leading, 4)
    return quaternion


def from_rpy(roll_pitch_yaw: ArrayLike) -> Array:
    """Rz(yaw)·Ry(pitch)·Rx(roll): turns about the fixed x, then y, then z axis (REP-103).

    Seed 1, eq. (1), with φ = yaw, θ = pitch, ψ = roll and the misprinted third column mended.
    """
    angles = np.asarray(roll_pitch_yaw, dtype=np.float64)
    (sr, sp, sy), (cr, cp, cy) = (np.moveaxis(f(angles), -1, 0) for f in (np.sin, np.cos))
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def to_rpy(rotation: ArrayLike) -> Array:
    """Roll, pitch, yaw of a matrix, pitch in [−π/2, π/2]; roll is 0 where pitch is ±π/2."""
    m = np.asarray(rotation, dtype=np.float64)
    cosine = np.hypot(m[..., 0, 0], m[..., 1, 0])
    pitch = np.arctan2(-m[..., 2, 0], cosine)
    locked = cosine < 1e-9
    roll = np.where(locked, 0.0, np.arctan2(m[..., 2, 1], m[..., 2, 2]))
    yaw = np.where(
        locked, np.arctan2(-m[..., 0, 1], m[..., 1, 1]), np.arctan2(m[..., 1, 0], m[..., 0, 0])
    )
    return np.stack([roll, pitch, yaw], axis=-1)
