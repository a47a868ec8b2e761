"""What a drawing of the machine is made of: bars along strokes, balls at their ends, colours.

A bar has a place, a direction, a length and a radius; a mesh has vertices (n, 3) and faces (m, 3).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexarm.panel.room import colour
from manipulator.arrays import Array
from manipulator.links import Stroke
from manipulator.pose import Pose
from manipulator.rotation import to_quaternion

Mesh = tuple[Array, NDArray[np.uint32]]
SIDES = 20


def bar() -> Mesh:
    """A closed cylinder of radius and length one, from the origin along z."""
    angles = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return plate(np.column_stack([ring, np.zeros(SIDES)]), 1.0)


def plate(outline: Array, thickness: float) -> Mesh:
    """A flat plate with a convex outline (n, 3) below it, `thickness` up along z.

    Caps have vertices of their own, so that edges stay sharp.
    """
    n = len(outline)
    up = np.array([0.0, 0.0, thickness])
    centre = outline.mean(axis=0)
    ring = np.vstack([outline, outline + up])
    vertices = np.vstack([ring, ring, centre, centre + up])
    here = np.arange(n)
    after = (here + 1) % n
    lower, upper = 2 * n + here, 3 * n + here
    sides = [(here, after, here + n), (after, after + n, here + n)]
    caps = [
        (np.full(n, 4 * n), lower[after], lower),
        (np.full(n, 4 * n + 1), upper, upper[after]),
    ]
    faces = np.vstack([np.stack(corners, axis=-1) for corners in (*sides, *caps)])
    return vertices, faces.astype(np.uint32)


def hull(points: Array) -> Mesh:
    """The surface through a grid of points (rows, columns, 3) that goes round by columns."""
    rows, columns = points.shape[:2]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing='ij')
    next_j = (j + 1) % columns
    a, b = i * columns + j, i * columns + next_j
    c, d = a + columns, b + columns
    faces = np.concatenate([np.stack([a, c, b], axis=-1), np.stack([b, c, d], axis=-1)])
    return points.reshape(-1, 3), faces.reshape(-1, 3).astype(np.uint32)


def sphere(rows: int, columns: int) -> Array:
    """Unit directions on a grid (rows, columns, 3), from pole to pole."""
    polar = np.linspace(0.0, np.pi, rows)[:, None]
    azimuth = np.linspace(0.0, 2.0 * np.pi, columns, endpoint=False)[None]
    x, y = np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth)
    return np.stack([x, y, np.cos(polar) + 0.0 * azimuth], axis=-1)


SHORTEST = 1e-9


@dataclass(frozen=True, eq=False)
class Bars:
    """Where n bars of length and radius one along z go: starts, sizes (n, 3), wxyz (n, 4)."""

    starts: Array
    wxyz: Array
    sizes: Array


def bars_between(starts: Array, ends: Array, radii: Array) -> Bars:
    """Bars from starts to ends (n, 3) with radii (n,), metres."""
    offsets = ends - starts
    lengths = np.linalg.norm(offsets, axis=-1)
    axes = offsets / np.maximum(lengths, SHORTEST)[:, None]
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


RADII = {
    'body': 0.012,
    'crank': 0.022,
    'rod': 0.014,
    'platform': 0.016,
    'link': 0.055,
    'gripper': 0.011,
}
"""Of bars, by part, as shares of the machine's size."""

PLAIN = {
    'body': (58, 68, 82),
    'platform': (62, 104, 168),
    'link': (62, 104, 168),
    'gripper': (196, 140, 40),
}
"""Parts whose colour means nothing; cranks, rods and joints are coloured by their margins."""

COLUMNS = ('crank', 'rod')
"""Parts of which each leg has one, in the order of the legs."""

THIN_END = 0.45
BALL = 1.35
"""Radii of the tool's end and of balls, as shares of the bar's."""

Colours = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Pieces:
    """n bars and m balls of a stance, lengths in machine sizes.

    parts (n) and owners (n), ball_owners (m) are what each is of, and which leg's or joint's
    margin it shows ('' for none).
    """

    bars: Bars
    balls: Array
    ball_radii: Array
    parts: tuple[str, ...]
    owners: tuple[str, ...]
    ball_owners: tuple[str, ...]


def pieces(strokes: tuple[Stroke, ...]) -> Pieces:
    """Bars along every stroke and balls at every point of it."""
    owners = _owners(strokes)
    counts = [len(stroke.points) - 1 for stroke in strokes]
    radii = [_radii(stroke) for stroke in strokes]
    return Pieces(
        bars_between(
            np.vstack([stroke.points[:-1] for stroke in strokes]),
            np.vstack([stroke.points[1:] for stroke in strokes]),
            np.concatenate([radius[:-1] for radius in radii]),
        ),
        np.vstack([stroke.points for stroke in strokes]),
        BALL * np.concatenate(radii),
        tuple(s.part for s, n in zip(strokes, counts, strict=True) for _ in range(n)),
        tuple(o for o, n in zip(owners, counts, strict=True) for _ in range(n)),
        tuple(o for k, stroke in enumerate(strokes) for o in _ball_owners(stroke, owners[k])),
    )


def colours(parts: tuple[str, ...], owners: tuple[str, ...], left: dict[str, float]) -> Colours:
    """(n, 3): by margin where the piece has an owner, else the part's own."""
    found = [
        colour(left.get(owner, 1.0)) if owner else PLAIN[part]
        for part, owner in zip(parts, owners, strict=True)
    ]
    return np.array(found, dtype=np.uint8)


def _owners(strokes: tuple[Stroke, ...]) -> list[str]:
    """Whose each stroke is, where it says so, else cranks and rods are counted, each by itself."""
    counts: dict[str, int] = {}
    found = []
    for stroke in strokes:
        counts[stroke.part] = counts.get(stroke.part, 0) + 1
        counted = stroke.owners[0] if stroke.owners else f'leg {counts[stroke.part]}'
        found.append(counted if stroke.part in COLUMNS else '')
    return found


def _ball_owners(stroke: Stroke, owner: str) -> list[str]:
    """A serial arm's line goes through its joints, each with limits of its own."""
    return list(stroke.owners) or [owner] * len(stroke.points)


def _radii(stroke: Stroke) -> Array:
    """(n,): at each point; arms get thinner towards the tool."""
    taper = np.linspace(1.0, THIN_END if stroke.part == 'link' else 1.0, len(stroke.points))
    radii: Array = RADII[stroke.part] * taper
    return radii
