"""Least squares by damped Gauss–Newton steps (Levenberg, Marquardt), slopes by differences."""

from collections.abc import Callable

import numpy as np

from manipulator.arrays import Array

STEP = 1e-6
MOST_ITERATIONS = 100
SMALLEST_GAIN = 1e-14


def descend(residuals: Callable[[Array], Array], start: Array) -> Array:
    """Where Σ residuals² has a local minimum, from `start` (n,).

    residuals maps (..., n) to (..., m), all variables being of about the same size.
    """
    x, damping = start, 1e-6
    if not x.size:
        return x
    now = residuals(x)
    for _ in range(MOST_ITERATIONS):
        slopes = (residuals(x + STEP * np.eye(x.size)) - now).T / STEP
        gradient, square = slopes.T @ now, slopes.T @ slopes
        while True:
            step = np.linalg.solve(square + damping * np.eye(x.size), -gradient)
            tried = residuals(x + step)
            gain = float(now @ now - tried @ tried)
            if gain > 0.0 or damping > 1e12:
                break
            damping *= 10.0
        if gain <= SMALLEST_GAIN * (1.0 + float(now @ now)):
            return x + step if gain > 0.0 else x
        x, now, damping = x + step, tried, max(damping / 10.0, 1e-9)
    return x
