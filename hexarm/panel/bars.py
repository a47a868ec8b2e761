"""Strokes as round bars: where each stands, how it is turned, how long and thick it is."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.pose import Pose
from manipulator.rotation import to_quaternion

SHORTEST = 1e-9


@dataclass(frozen=True, eq=False)
class Bars:
    """Where n bars of length and radius one along z go: starts, sizes (n, 3), wxyz (n, 4)."""

    starts: Array
    wxyz: Array
    sizes: Array


def bars_between(starts: Array, ends: Array, radii: Array) -> Bars:
    """Bars from starts to ends (n, 3) with radii (n,), metres."""
    way = ends - starts
    lengths = np.linalg.norm(way, axis=-1)
    axes = way / np.maximum(lengths, SHORTEST)[:, None]
    axes[lengths < SHORTEST] = (0.0, 0.0, 1.0)
    sizes = np.stack([radii, radii, np.maximum(lengths, SHORTEST)], axis=-1)
    return Bars(starts, _turns_from_z(axes), sizes)


def wxyz_of(pose: Pose) -> Array:
    """The orientation in viser's order."""
    return np.roll(to_quaternion(pose.rotation), 1, axis=-1)


def _turns_from_z(axes: Array) -> Array:
    """The least turn of z into each axis: w = 1 + cos, vector = z × axis; half a turn about x."""
    w = 1.0 + axes[:, 2]
    turns = np.stack([w, -axes[:, 1], axes[:, 0], np.zeros(len(axes))], axis=-1)
    turns[w < SHORTEST] = (0.0, 1.0, 0.0, 0.0)
    unit: Array = turns / np.linalg.norm(turns, axis=-1, keepdims=True)
    return unit
