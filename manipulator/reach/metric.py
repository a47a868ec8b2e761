"""Distances between poses: metres, with rotations made lengths by the characteristic length."""

import numpy as np

from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

CHECKS_PER_LENGTH = 70
"""How closely a way is checked: as the walkers of the workspace are."""


def scale(machine: Machine) -> Array:
    """(6,): a twist times it is in metres."""
    return np.array([1.0] * 3 + [machine.kinematics.characteristic_length] * 3)


def offset(machine: Machine, start: Pose, end: Pose) -> Array:
    """The twist from start to end in metres (..., 6)."""
    result: Array = start.twist_to(end) * scale(machine)
    return result


def distance(machine: Machine, start: Pose, end: Pose) -> Array:
    """√(|Δp|² + L²·angle²) in metres (...), L the characteristic length."""
    result: Array = np.linalg.norm(offset(machine, start, end), axis=-1)
    return result


def displaced(machine: Machine, pose: Pose, step: Array) -> Pose:
    """The pose moved by a step (..., 6) in metres."""
    return pose.moved(step / scale(machine))
