"""Levenberg–Marquardt with tolerances: the most probable values, given errors and a prior.

Minimises |r(x)|² + |x|² where r are errors in multiples of their noise and x values in multiples
of their tolerances; where a tolerance is infinite, that value has no prior and x counts in SI.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import NoSolution

Errors = Callable[[Array], tuple[Array, Array]]
"""Values (p,) to errors (m,) and their slopes (m, p)."""

MOST_EVALUATIONS = 200
STILL = 1e-10
BEYOND = 1e9
"""The error, by its noise, where the machine cannot stand: a shorter step is tried instead."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Values (p,) and their covariance (p, p), errors and prior taken together."""

    values: Array
    covariance: Array


def fit(errors: Errors, tolerances: Array) -> Fit:
    """The values (p,), beginning at zero; NoSolution where no minimum is found."""
    from scipy.optimize import least_squares  # noqa: PLC0415 (50 MB: for who asks)

    has_prior = np.isfinite(tolerances)
    scale, prior = np.where(has_prior, tolerances, 1.0), np.diag(has_prior.astype(np.float64))
    beyond = np.full_like(errors(np.zeros(len(scale)))[0], BEYOND), np.zeros((0, len(scale)))

    @lru_cache(maxsize=1)  # MINPACK asks for errors and for slopes, which are found together
    def at(x: tuple[float, ...]) -> tuple[Array, Array]:
        values = np.array(x)
        try:
            r, J = errors(scale * values)
        except NoSolution:
            r, J = beyond
        return np.concatenate([r, prior @ values]), np.concatenate([J * scale, prior])

    found = least_squares(
        lambda x: at(tuple(x))[0], np.zeros(len(scale)), lambda x: at(tuple(x))[1], method='lm',
        x_scale='jac', ftol=STILL, xtol=STILL, gtol=STILL, max_nfev=MOST_EVALUATIONS,
    )  # fmt: skip
    if not found.success:
        raise NoSolution('the parameters do not converge: are the measurements of this machine?')
    inverse = scale[:, None] * np.linalg.pinv(found.jac)
    return Fit(scale * found.x, inverse @ inverse.T)
