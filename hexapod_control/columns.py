"""Legs first, poses last: the layout in which arrays of poses are quick to work on."""

from collections.abc import Iterator

import numpy as np

from manipulator.arrays import Array
from manipulator.pose import Pose

MANY = 64  # poses from which on columns are quicker than a matrix for each pose
CHUNK = 1024  # poses at once: what they need stays in the cache


def unit_rods_and_arms(
    base_points: Array, platform_points: Array, pose: Pose
) -> tuple[Array, Array]:
    """Unit rod directions and R aᵢ, both (3, 6, N) in base axes, of N poses.

    base_points (6, 3) or (N, 6, 3), platform_points (6, 3), metres.
    """
    count = pose.position.shape[0]
    arms = turned_columns(platform_points, pose)
    rods = arms + pose.position.T[:, None, :]
    rods -= np.moveaxis(np.broadcast_to(base_points, (count, 6, 3)), (0, 1, 2), (2, 1, 0))
    rods /= np.sqrt((rods * rods).sum(axis=0))
    return rods, arms


def turned_columns(vectors: Array, pose: Pose) -> Array:
    """R v (3, k, N) of vectors (k, 3), for N poses."""
    turned = pose.rotation.reshape(-1, 3) @ vectors.T
    return np.ascontiguousarray(np.moveaxis(turned.reshape(-1, 3, len(vectors)), 0, -1))


def chunks(pose: Pose, joints: Array) -> Iterator[tuple[slice, Pose, Array]]:
    """Parts of N poses with their joints (N, n), and where they stand."""
    for start in range(0, len(joints), CHUNK):
        part = slice(start, start + CHUNK)
        yield part, Pose.unchecked(pose.position[part], pose.rotation[part]), joints[part]
