"""The point of a polyhedron nearest to another: Lawson & Hanson, Least Squares Problems."""

import numpy as np

from manipulator.arrays import Array

TOLERANCE = 1e-12


def nearest_point(target: Array, normals: Array, slack: Array) -> tuple[Array, Array]:
    """The y nearest to `target` (n,) with normals·y + slack ≥ 0, and its multipliers (m,).

    target − y = −normalsᵀ·multipliers. Least distance programming, chapter 23. Where no y does,
    or none is found, y is `target` and the multipliers are NaN.
    """
    from scipy.optimize import nnls  # noqa: PLC0415 (50 MB: only needed here)

    lacking = -(slack + normals @ target)
    matrix = np.vstack([normals.T, lacking])
    right = np.zeros(len(matrix))
    right[-1] = 1.0
    nowhere = target, np.full(len(slack), np.nan)
    try:
        weights = nnls(matrix, right)[0]
    except RuntimeError:  # too many iterations
        return nowhere
    residual = matrix @ weights - right
    if residual[-1] > -TOLERANCE:
        return nowhere
    return target - residual[:-1] / residual[-1], -weights / residual[-1]
