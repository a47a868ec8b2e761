"""The point of a polyhedron nearest to another: Lawson & Hanson, Least Squares Problems."""

import numpy as np

from manipulator.arrays import Array

TOLERANCE = 1e-12
MOST_STEPS = 200


def nearest_point(target: Array, normals: Array, slack: Array) -> tuple[Array, Array]:
    """The y nearest to `target` (n,) with normals·y + slack ≥ 0, and its multipliers (m,).

    target − y = −normalsᵀ·multipliers. Least distance programming, chapter 23. Where no y does,
    y is `target` and the multipliers are NaN.
    """
    lacking = -(slack + normals @ target)
    matrix = np.vstack([normals.T, lacking])
    right = np.zeros(len(matrix))
    right[-1] = 1.0
    weights = nonnegative_least_squares(matrix, right)
    residual = matrix @ weights - right
    if residual[-1] > -TOLERANCE:
        return target, np.full(len(slack), np.nan)
    return target - residual[:-1] / residual[-1], -weights / residual[-1]


def nonnegative_least_squares(matrix: Array, right: Array) -> Array:
    """The x ≥ 0 that minimises |matrix·x − right|: algorithm NNLS, chapter 23."""
    count = matrix.shape[1]
    x, is_free = np.zeros(count), np.zeros(count, dtype=np.bool_)
    for _ in range(MOST_STEPS):
        gradient = matrix.T @ (right - matrix @ x)
        gradient[is_free] = -np.inf
        entering = int(np.argmax(gradient))
        if gradient[entering] <= TOLERANCE * np.linalg.norm(matrix[:, entering]):
            break
        is_free[entering] = True
        while True:
            trial = np.zeros(count)
            trial[is_free] = np.linalg.lstsq(matrix[:, is_free], right, rcond=None)[0]
            leaving = is_free & (trial <= 0.0)
            if not leaving.any():
                break
            step = np.min(x[leaving] / (x[leaving] - trial[leaving]))
            x = np.maximum(x + step * (trial - x), 0.0)
            is_free &= ~(leaving & (x <= TOLERANCE))
        x = trial
    return x
