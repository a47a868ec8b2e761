"""Rotations as matrices: quaternions, roll-pitch-yaw, and the exponential map of SO(3).

All functions broadcast over leading axes. Quaternions are x, y, z, w as in ROS.
"""

import numpy as np
from numpy.typing import ArrayLike

from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.errors import InvalidInput

UNIT_TOLERANCE = 1e-3
_TOLERANCE = frozen([UNIT_TOLERANCE])


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
    a, b = (factor[..., None, None] for factor in _factors(_norm(w)))
    k = skew(w)
    matrix: Array = np.eye(3) + a * k + b * (k @ k)
    return matrix


def turning(w: Array, w_rate: Array, w_acceleration: Array) -> tuple[Array, Array]:
    """The angular velocity and acceleration of exp(w), fixed axes, for ẇ and ẅ; (..., 3) each.

    ω = J(w) ẇ and α = J(w) ẅ + J̇(w) ẇ, where J = 1 + a W + b W² with W x = w × x, so that
    J̇ ẇ = (w·ẇ)(a'/θ W + b'/θ W²) ẇ + b ẇ × (w × ẇ), θ = |w|.
    """
    angle = _norm(w)[..., None]
    a, b = _factors(angle)
    small, safe = angle < SMALL, np.maximum(angle, SMALL)
    a_slope = np.where(small, angle**2 / 180 - 1 / 12, (_sine(angle) - 2 * a) / safe**2)
    b_slope = np.where(small, angle**2 / 1260 - 1 / 60, (a - 3 * b) / safe**2)
    cross, both = skew(w), np.stack([w_rate, w_acceleration], axis=-1)
    once = cross @ both
    twice = cross @ once
    turned = both + a[..., None] * once + b[..., None] * twice
    along = (w * w_rate).sum(axis=-1, keepdims=True)
    change = along * (a_slope * once[..., 0] + b_slope * twice[..., 0] - b * w_rate)
    change += (w_rate * w_rate).sum(axis=-1, keepdims=True) * b * w
    return turned[..., 0], turned[..., 1] + change


SMALL = 0.01
"""Radians below which differences of almost equal numbers are summed as series."""


def _norm(w: Array) -> Array:
    norm: Array = np.sqrt(np.einsum('...i,...i->...', w, w))
    return norm


def _sine(angle: Array) -> Array:
    """sin(θ)/θ, also at 0."""
    away = np.maximum(angle, 1e-12)
    sine: Array = np.sin(away) / away
    return sine


def _factors(angle: Array) -> tuple[Array, Array]:
    """(1 − cos θ)/θ² and (θ − sin θ)/θ³, (...) each."""
    safe = np.maximum(angle, SMALL)
    second = np.where(angle < SMALL, 1 / 6 - angle**2 / 120, (1 - _sine(angle)) / safe**2)
    return _sine(angle / 2) ** 2 / 2, second


def from_quaternion(quaternion: ArrayLike) -> Array:
    """The matrix of a unit quaternion x, y, z, w.

    Lengths within 0.1 % of one are normalised; any other raises InvalidInput.
    """
    q = _shaped(quaternion, (4,))
    matrix = np.empty((*q.shape[:-1], 3, 3))
    if _kernel.rotation_of(_TOLERANCE, q, matrix):
        lengths = np.ravel(np.linalg.norm(q, axis=-1))
        worst = lengths[np.argmax(np.abs(np.nan_to_num(lengths, nan=9.9) - 1))]
        raise InvalidInput(f'quaternion has length {worst:.6g}, a rotation needs 1 ± 0.001')
    return matrix


def to_quaternion(rotation: ArrayLike) -> Array:
    """The unit quaternion x, y, z, w with w ≥ 0; (..., 3, 3) to (..., 4)."""
    matrix = _shaped(rotation, (3, 3))
    quaternion = np.empty((*matrix.shape[:-2], 4))
    _kernel.quaternion_of(matrix, quaternion)
    return quaternion


def from_rpy(roll_pitch_yaw: ArrayLike) -> Array:
    """Rz(yaw)·Ry(pitch)·Rx(roll): turns about the fixed x, then y, then z axis (REP-103).

    Prokopovich 2019, eq. (1), with φ = yaw, θ = pitch, ψ = roll; its third column is misprinted.
    """
    angles = np.asarray(roll_pitch_yaw, dtype=np.float64)
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles).T, np.cos(angles).T
    matrix: Array = np.array(
        [
            (cy * cp, sy * cp, -sp),
            (cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
            (cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr),
        ]
    ).T
    return matrix


def to_rpy(rotation: ArrayLike, locked: float = 1e-9) -> Array:
    """Roll, pitch, yaw of a matrix, pitch in [−π/2, π/2]; roll is 0 where pitch is ±π/2.

    Within `locked` (rad) of it, which is the error there. Yaw makes good what rounding did to
    roll, so that `from_rpy` leads back however near to ±π/2 pitch is.
    """
    m = np.asarray(rotation, dtype=np.float64)
    cosine = np.hypot(m[..., 0, 0], m[..., 1, 0])
    pitch = np.arctan2(-m[..., 2, 0], cosine)
    roll = np.where(cosine < locked, 0.0, np.arctan2(m[..., 2, 1], m[..., 2, 2]))
    s, c = np.sin(roll), np.cos(roll)
    yaw = np.arctan2(s * m[..., 0, 2] - c * m[..., 0, 1], c * m[..., 1, 1] - s * m[..., 1, 2])
    return np.stack([roll, pitch, yaw], axis=-1)


EXACTLY = 1e-14
"""As `locked` of `to_rpy`: for files, which are to lead back to the same rotation."""
