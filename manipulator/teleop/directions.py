"""Turns that bring one direction to another, or an orientation to a family of them."""

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array


def turn_between(direction: Array, wanted: Array) -> Array:
    """The shortest rotation vector (3,) that turns one unit vector into the other.

    For opposite vectors, half a turn about some axis at a right angle to them.
    """
    axis = np.cross(direction, wanted)
    sine, cosine = float(np.linalg.norm(axis)), float(direction @ wanted)
    if sine > 1e-9:
        result: Array = axis * (np.arctan2(sine, cosine) / sine)
        return result
    if cosine > 0:
        return np.zeros(3)
    across = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    half_turn: Array = np.pi * across / np.linalg.norm(across)
    return half_turn


def turn_but_about(axis: Array, rotation: Array) -> Array:
    """The rotation vector of `rotation` without its part about the unit `axis`.

    It is the shortest among those of Rot(axis, θ)·rotation for all θ, at a right angle to `axis`
    (swing-twist decomposition of the unit quaternion).
    """
    quaternion = so3.to_quaternion(rotation)
    angle = 2.0 * np.arctan2(quaternion[:3] @ axis, quaternion[3])
    result: Array = so3.log(so3.exp(-angle * axis) @ rotation)
    return result
