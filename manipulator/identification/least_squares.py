"""Levenberg–Marquardt with tolerances: the most probable values, given errors and a prior.

Minimises |r(x)|² + |x|² where r are errors in multiples of their noise and x values in multiples
of their tolerances; where a tolerance is infinite, that value has no prior and x counts in SI.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import NoSolution

Errors = Callable[[Array], tuple[Array, Array]]
"""Values (p,) to errors (m,) and their slopes (m, p)."""

MOST_STEPS = 60
STILL = 1e-9
FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-12, 1e12


@dataclass(frozen=True, eq=False)
class Fit:
    """values (p,) and their covariance (p, p) with the prior; slopes (m, p) at the values."""

    values: Array
    covariance: Array
    errors: Array
    slopes: Array
    steps: int


def fit(errors: Errors, tolerances: Array) -> Fit:
    """The values (p,), beginning at zero; NoSolution where no minimum is found."""
    has_prior = np.isfinite(tolerances)
    scale = np.where(has_prior, tolerances, 1.0)
    prior = has_prior.astype(np.float64)
    x, damping = np.zeros(len(scale)), FIRST_DAMPING
    r, J = errors(scale * x)
    for step in range(MOST_STEPS):
        A = (J * scale).T @ (J * scale) + np.diag(prior)
        g = scale * (J.T @ r) + prior * x
        # Unseen values without a prior stay where they are: their diagonal is zero.
        damped = A + damping * np.diag(np.maximum(np.diag(A), 1e-9))
        way = -np.linalg.lstsq(damped, g, rcond=None)[0]
        if np.abs(way * np.sqrt(np.diag(A))).max() < STILL:
            covariance = scale[:, None] * np.linalg.pinv(A, hermitian=True) * scale
            return Fit(scale * x, covariance, r, J, step)
        try:
            r_new, J_new = errors(scale * (x + way))
        except NoSolution:
            damping *= 10.0
        else:
            is_better = _cost(r_new, prior * (x + way)) <= _cost(r, prior * x) * (1 + 1e-12)
            if is_better:
                x, r, J = x + way, r_new, J_new
            damping = max(damping / 10.0, LEAST_DAMPING) if is_better else damping * 10.0
        if damping > MOST_DAMPING:
            break
    raise NoSolution('the parameters do not converge: are the measurements of this machine?')


def _cost(errors: Array, pulled: Array) -> float:
    return float(errors @ errors + pulled @ pulled)
