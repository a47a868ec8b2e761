"""Between which values each coordinate of a goal may go while the other five stay.

Coordinates are x, y, z in metres and roll, pitch, yaw in radians, of the platform or tool in the
base frame. Changing one alone is a twist about a fixed axis, so `travel` answers it exactly.
"""

import numpy as np

from manipulator import rotation as so3
from manipulator.analysis.free_paths import is_by_joints
from manipulator.analysis.travel import travel
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

AXES = ('x', 'y', 'z', 'roll', 'pitch', 'yaw')
SPARE = 1.3
"""How much wider the bounds are than what home reaches: elsewhere there may be more."""


def coordinate_twists(pose: Pose) -> Array:
    """(6, 6): row k is the twist of a unit speed of coordinate k alone, in base axes.

    R = Rz(yaw) Ry(pitch) Rx(roll): yaw turns about the base's z, pitch about the y axis that
    yaw has turned, roll about the moving x axis.
    """
    roll_axis = pose.rotation[:, 0]
    yaw = float(pose.rpy[2])
    pitch_axis = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
    twists = np.zeros((6, 6))
    twists[:3, :3] = np.eye(3)
    twists[3, 3:], twists[4, 3:], twists[5, 5] = roll_axis, pitch_axis, 1.0
    return twists


def reachable_ranges(machine: Machine, pose: Pose, near: Array | None = None) -> Array:
    """(6, 2): how far below and above its value each coordinate may go; zeros out of reach."""
    twists = coordinate_twists(pose)
    ends = [
        [-travel(machine, pose, -twist, near).seconds, travel(machine, pose, twist, near).seconds]
        for twist in twists
    ]
    return np.array(ends)


def bounds(machine: Machine) -> Array:
    """(6, 2): between which values sliders go, a little more than the machine reaches."""
    home = coordinates(machine.kinematics.home)
    if is_by_joints(machine):
        ends = machine.kinematics.characteristic_length * 2.5 * np.array([-1.0, 1.0])
        turn = home[3:, None] + np.array([[-np.pi, np.pi]] * 3)
        turn[1] = -np.pi / 2, np.pi / 2
        return np.vstack([np.tile(ends, (3, 1)), turn])
    return home[:, None] + SPARE * reachable_ranges(machine, machine.kinematics.home)


def coordinates(pose: Pose, near: Array | None = None) -> Array:
    """(6,): position and roll, pitch, yaw; angles within half a turn of `near` (6,)."""
    found = np.concatenate([pose.position, pose.rpy])
    if near is not None:
        turns = np.round((near[3:] - found[3:]) / (2.0 * np.pi))
        found[3:] += 2.0 * np.pi * turns
    return found


def pose_at(values: Array) -> Pose:
    """The pose of six coordinates."""
    return Pose(values[:3], so3.from_rpy(values[3:]))
