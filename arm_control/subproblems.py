"""The trigonometric subproblems that closed-form inverses are made of (docs/arm-kinematics.md, 3).

Vectors are (..., 3) and broadcast; k is a constant unit axis (3,). NaN marks what has no solution
and passes through. `free` is the angle taken where every angle solves the equation.
"""

import numpy as np

from manipulator.arrays import Array
from manipulator.rotation import skew

SLACK = 1e-9
"""Relative overshoot that counts as rounding: 1e-9 of a 1 m reach is a nanometre."""
ON_AXIS = 1e-15
"""Product of the sines of two vectors' angles to an axis, below which they lie on it."""


def rotate(k: Array, angle: Array, vector: Array) -> Array:
    """`vector` turned by `angle` (...) about k (Rodrigues' formula)."""
    along = (vector @ k)[..., None] * k
    cosine, sine = np.cos(angle)[..., None], np.sin(angle)[..., None]
    result: Array = along + cosine * (vector - along) + sine * (vector @ skew(k).T)
    return result


def facing_angle(k: Array, vector: Array, target: Array, free: Array) -> Array:
    """θ that turns `vector` about k into the half-plane of `target` (Paden–Kahan 1).

    `free` where one of the two lies on the axis.
    """
    sine = _dot(target, vector @ skew(k).T)
    cosine = _dot(target, vector) - (target @ k) * (vector @ k)
    on_axis = np.hypot(sine, cosine) <= ON_AXIS * _length(vector) * _length(target)
    result: Array = np.where(on_axis, free, np.arctan2(sine, cosine))
    return result


def projection_angles(k: Array, vector: Array, onto: Array, value: Array, free: Array) -> Array:
    """Both θ with onto · R(k, θ)·vector = value: (..., 2), the second NaN with the first.

    A cos θ + B sin θ = C has θ = atan2(B, A) ± arccos(C / √(A² + B²)).
    """
    vector, onto = np.broadcast_arrays(vector, onto)
    a = _dot(onto, vector) - (onto @ k) * (vector @ k)
    b = _dot(onto, vector @ skew(k).T)
    c = value - (onto @ k) * (vector @ k)
    radius = np.hypot(a, b)
    slack = SLACK * _length(onto) * _length(vector) + 1e-15
    below = (radius - c) * (radius + c)
    with np.errstate(invalid='ignore'):
        half = np.arctan2(np.sqrt(np.maximum(below, 0.0)), c)
        half = np.where(np.abs(c) > radius + slack, np.nan, half)
    middle = np.arctan2(b, a)
    either = np.stack([middle + half, middle - half], axis=-1)
    is_free = (radius < slack) & (np.abs(c) < slack)
    result: Array = np.where(is_free[..., None], np.asarray(free)[..., None], either)
    return result


def distance_angles(k: Array, vector: Array, point: Array, distance: Array, free: Array) -> Array:
    """Both θ that bring R(k, θ)·vector to `distance` from `point` (Paden–Kahan 3): (..., 2)."""
    value = (_dot(vector, vector) + _dot(point, point) - distance**2) / 2
    return projection_angles(k, vector, point, value, free)


def perpendicular(k: Array) -> Array:
    """Some unit vector at a right angle to k (3,)."""
    other = np.eye(3)[np.argmin(np.abs(k))]
    across: Array = np.cross(k, other)
    result: Array = across / np.sqrt(_dot(across, across))
    return result


def _dot(a: Array, b: Array) -> Array:
    result: Array = np.einsum('...i,...i->...', a, b)
    return result


def _length(a: Array) -> Array:
    result: Array = np.sqrt(_dot(a, a))
    return result
