"""The trigonometric subproblems that closed-form inverses are made of (docs/arm-kinematics.md, 3).

Vectors are (..., 3) and broadcast; k is a constant unit axis (3,). NaN marks what has no solution
and passes through. `free` is the angle taken where every angle solves the equation. Shoulder and
elbow, two joints with parallel axes, are one of them.
"""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
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


@dataclass(frozen=True, eq=False)
class TwoLink:
    """Joints 1 to 3 of `chain` bringing `tip`, a point (3,) at zero angles, to its target.

    Joint 1 turns the plane of joints 2 and 3 through the target; those two triangulate it.
    """

    chain: Chain
    tip: Array

    def joint_1(self, target: Array, free: Array) -> Array:
        """Both turns of the arm's plane towards target (..., 3): (..., 2)."""
        axis, across = self.chain.axes[0], self.chain.axes[1]
        origin = self.chain.points[0]
        offset = np.dot(across, self.tip - origin)
        return projection_angles(axis, across, target - origin, offset, free)

    def in_joint_1(self, target: Array, q1: Array) -> Array:
        """The target as joint 1's link sees it: turned back by q1."""
        p1 = self.chain.points[0]
        local: Array = p1 + rotate(self.chain.axes[0], -q1, target - p1)
        return local

    def joint_3(self, target: Array, free: Array) -> Array:
        """Both elbow angles for the target in joint 1's frame (..., 3): (..., 2)."""
        _, p2, p3 = self.chain.points[:3]
        distance = np.linalg.norm(target - p2, axis=-1)
        return distance_angles(self.chain.axes[2], self.tip - p3, p2 - p3, distance, free)

    def joint_2(self, target: Array, q3: Array, free: Array) -> Array:
        """The shoulder angle for the target in joint 1's frame, with the elbow at q3."""
        _, p2, p3 = self.chain.points[:3]
        reached = p3 + rotate(self.chain.axes[2], q3, self.tip - p3) - p2
        return facing_angle(self.chain.axes[1], reached, target - p2, free)

    def joint_1_refusal(self, name: str, target: Array) -> str:
        """How near to joint 1's axis the target (3,) is, and may be."""
        axis, across = self.chain.axes[0], self.chain.axes[1]
        arm = target - self.chain.points[0]
        distance = np.linalg.norm(arm - np.dot(arm, axis) * axis)
        needed = abs(np.dot(across, self.tip - self.chain.points[0]))
        return f"{name} {distance:.4g} m from joint 1's axis, needs at least {needed:.4g} m"

    def elbow_refusal(self, name: str, targets: Array) -> str:
        """How far from the shoulder the best of the targets (k, 3) is, and may be.

        All in joint 1's frame, measured in the plane of the two links.
        """
        across = self.chain.axes[1]
        _, p2, p3 = self.chain.points[:3]
        arms = np.vstack([p3 - p2, self.tip - p3, targets - p2])
        upper, fore, *wanted = np.linalg.norm(arms - np.outer(arms @ across, across), axis=1)
        reach, core = float(upper + fore), float(abs(upper - fore))
        distance = float(min(wanted, key=lambda w: max(w - reach, core - w)))
        bound = f'reach is {reach:.4g} m' if distance > reach else f'needs at least {core:.4g} m'
        return f'{name} {distance:.4g} m from the shoulder, {bound}'


def lattice(joints: tuple[Array, ...]) -> Array:
    """Joints, each (..., 1 or 2, 1 or 2, 1 or 2), as branches (..., 8, n): all NaN or none."""
    grid = np.stack(np.broadcast_arrays(*joints), axis=-1)
    lost = np.isnan(grid).any(axis=-1, keepdims=True)
    result: Array = np.where(lost, np.nan, grid).reshape(*grid.shape[:-4], 8, len(joints))
    return result
