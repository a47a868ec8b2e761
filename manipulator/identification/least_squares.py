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

MOST_STEPS = 200
STILL = 1e-8
"""A step this small, per noise and per error that is left, is the last."""

FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-12, 1e12


@dataclass(frozen=True, eq=False)
class Fit:
    """Values (p,) and their covariance (p, p), errors and prior taken together."""

    values: Array
    covariance: Array
    steps: int


def fit(errors: Errors, tolerances: Array) -> Fit:
    """The values (p,), beginning at zero; NoSolution where no minimum is found."""
    has_prior = np.isfinite(tolerances)
    scale = np.where(has_prior, tolerances, 1.0)
    prior = has_prior.astype(np.float64)
    x, damping = np.zeros(len(scale)), FIRST_DAMPING
    r, J = errors(scale * x)
    for step in range(MOST_STEPS):
        rows = np.concatenate([J * scale, np.diag(prior)])
        left = np.concatenate([r, prior * x])
        lengths = np.sqrt((rows * rows).sum(axis=0))
        # Unseen values without a prior stay where they are: nothing but damping is in their rows.
        damped = np.concatenate([rows, np.sqrt(damping) * np.diag(np.maximum(lengths, 1e-5))])
        way = -np.linalg.lstsq(damped, np.concatenate([left, 0.0 * x]), rcond=None)[0]
        cost = float(left @ left)
        if np.abs(way * lengths).max() < STILL * (1.0 + np.sqrt(cost)):
            inverse = scale[:, None] * np.linalg.pinv(rows)
            return Fit(scale * x, inverse @ inverse.T, step)
        try:
            r_new, J_new = errors(scale * (x + way))
        except NoSolution:
            damping *= 10.0
        else:
            pulled = prior * (x + way)
            is_better = float(r_new @ r_new + pulled @ pulled) <= cost * (1 + 1e-12)
            if is_better:
                x, r, J = x + way, r_new, J_new
            damping = max(damping / 10.0, LEAST_DAMPING) if is_better else damping * 10.0
        if damping > MOST_DAMPING:
            break
    raise NoSolution('the parameters do not converge: are the measurements of this machine?')
