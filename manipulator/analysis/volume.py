"""Volumes of positions that a machine reaches, with the error of the estimate.

docs/workspace.md, section 3.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from manipulator.analysis.free_paths import admits
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose

REPLICAS = 16
STUDENT = 2.131  # 95 % of Student's t with 15 degrees of freedom lie within
CONFIDENCE = 0.95
GOLDEN = 1.22074408460575947536  # x⁴ = x + 1: the best lattice of points on a line in 3D
PILOT = 20_000
PADDING = 0.2
MOST_DOUBLINGS = 8

Reached = Callable[[Array], Mask]
"""Which positions (N, 3) in metres belong to a workspace."""


@dataclass(frozen=True)
class Volume:
    """In m³; the truth lies within ± error with a probability of `confidence`."""

    value: float
    error: float
    points: int
    confidence: float = CONFIDENCE


@dataclass(frozen=True, eq=False)
class Box:
    """Positions from low to high (3,), metres."""

    low: Array
    high: Array

    @property
    def volume(self) -> float:
        """In m³."""
        return float(np.prod(self.high - self.low))

    def lattice(self, count: int, shift: Array) -> Array:
        """Positions (count, 3) spread evenly: a Kronecker sequence, moved by a shift in [0, 1)."""
        steps = (1.0 / GOLDEN) ** np.arange(1, 4)
        shares = (np.arange(1, count + 1)[:, None] * steps + shift) % 1.0
        places: Array = self.low + shares * (self.high - self.low)
        return places


def with_orientation(machine: Machine, rotation: Array) -> Reached:
    """The positions that are admitted with one orientation (3, 3)."""

    def reached(positions: Array) -> Mask:
        turned = np.broadcast_to(rotation, (len(positions), 3, 3))
        return admits(machine, Pose(positions, turned))

    return reached


def bounding_box(
    reached: Reached,
    centre: Array,
    size: float,
    pilot: int = PILOT,
    on_progress: Callable[[float], None] = lambda share: None,
) -> Box:
    """A box that holds all that is reached about `centre`, found from a box of ±size (m).

    It is doubled until nothing reached lies in its outer tenths, then fitted with a fifth to
    spare on each side. It holds no more than `centre` where no position was found.
    """
    last = centre[None]
    for doubling in range(MOST_DOUBLINGS):
        on_progress(doubling / MOST_DOUBLINGS)
        box = Box(centre - size, centre + size)
        places = box.lattice(pilot, np.full(3, 0.5))
        inside = places[reached(places)]
        last = inside if len(inside) else last
        if len(inside) and np.abs(inside - centre).max() > 0.9 * size:
            size *= 2.0
        elif len(inside) < pilot // 200:
            size = 1.2 * float(np.abs(inside - centre).max()) if len(inside) else size / 2.0
        else:
            break
    on_progress(1.0)
    low, high = last.min(axis=0), last.max(axis=0)
    spare = PADDING * (high - low)
    return Box(low - spare, high + spare)


def volume(
    reached: Reached,
    box: Box,
    points: int,
    generator: np.random.Generator,
    on_progress: Callable[[float], None] = lambda share: None,
) -> Volume:
    """Of the part of `box` that is reached, from `points` positions in all.

    Sixteen copies of a lattice, each moved at random, give sixteen independent unbiased
    estimates; their spread is the error of the mean, by Student's t.
    """
    each = max(points // REPLICAS, 1)
    shares = np.empty(REPLICAS)
    for k in range(REPLICAS):
        shares[k] = reached(box.lattice(each, generator.uniform(size=3))).mean()
        on_progress((k + 1) / REPLICAS)
    error = STUDENT * float(shares.std(ddof=1) / np.sqrt(REPLICAS))
    return Volume(box.volume * float(shares.mean()), box.volume * error, each * REPLICAS)
