"""The point of a polyhedron nearest to another: Lawson & Hanson, Least Squares Problems."""

import numpy as np

from manipulator import _kernel
from manipulator.arrays import Array, stretched


def nearest_point(target: Array, normals: Array, slack: Array) -> tuple[Array, Array]:
    """The y nearest to `target` (6,) with normals·y + slack ≥ 0, and its multipliers (m,).

    y − target = normalsᵀ·multipliers. Least distance programming, chapter 23. Where no y does,
    or none is found, y is `target` and the multipliers are NaN.
    """
    rows, bounds = stretched(normals, (len(slack), 6)), stretched(slack, np.shape(slack))
    weights = np.empty(len(bounds))
    if not _kernel.least_distance(stretched(target, (6,)), rows, bounds, weights):
        return target, np.full(len(bounds), np.nan)
    return target + weights @ rows, weights
