"""Meshes of the few solids that a machine is drawn with: vertices (n, 3) and faces (m, 3)."""

import numpy as np
from numpy.typing import NDArray

from manipulator.arrays import Array

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
