"""What every MuJoCo model of a machine is: its XML, the names in it, and where a pose puts it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hexarm.simulation.drives import Drives
from manipulator.arrays import Array
from manipulator.pose import Pose

Seat = Callable[[Pose, Array], Array]
"""From a pose and its joints (n,) to the model's coordinates qpos."""


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A model of one machine, before MuJoCo has read it.

    joints and their actuators share names, in the kinematics' order; the body `moving` is the
    platform or tool, with its frame; closures are pairs of sites that the closed loops join, by
    whose they are.
    """

    name: str
    xml: str
    joints: tuple[str, ...]
    joint_unit: str
    moving: str
    closures: dict[str, tuple[str, str]]
    drives: Drives
    seat: Seat


def free_body(pose: Pose) -> Array:
    """The qpos of a free body: position, then the quaternion w, x, y, z."""
    x, y, z, w = pose.quaternion
    return np.concatenate([pose.position, [w, x, y, z]])
