"""The differential method of Fadeev and Loginov: position first, then three projections.

It has singularities that the arm has not (a_y = 0, s_z = 0), and its correction of the whole
error in one period diverges over a delay. So it stands here to be compared with; the nodes jog
with resolved_rate.py.
"""

import numpy as np

from hexarm.papers.paper_arm import (
    PaperArm,
    position_rates_factors,
    projection_rates,
    wrist_factors,
)
from manipulator.arrays import Array
from manipulator.errors import NoSolution

SINGULAR = 1e-6
"""Factor of a determinant, dimensionless, below which its system is not solved."""


def velocity_towards(target: Array, present: Array, period: float) -> Array:
    """X' = (X_n − X_{n−1}) / T, m/s; the present position is measured where it can be."""
    return (np.asarray(target) - np.asarray(present)) / period


def joint_rates(arm: PaperArm, q: Array, velocity: Array, turning: Array | None = None) -> Array:
    """q1' … q6' in rad/s for the velocity of C (3,) in m/s, at joints (6,).

    turning is (a_x', a_z', n_z') in 1/s, zero by default: the orientation is kept. Raises
    NoSolution, naming the factor of the determinant that vanishes, and whether the arm itself is
    singular there or only these three projections are.
    """
    _check(position_rates_factors(arm, q))
    first = np.linalg.solve(arm.position_rates(q), velocity)
    _check(wrist_factors(q))
    rates = projection_rates(q)
    wanted = np.zeros(3) if turning is None else turning
    last = np.linalg.solve(rates[:, 3:], wanted - rates[:, :3] @ first)
    return np.concatenate([first, last])


def _check(factors: dict[str, float]) -> None:
    for name, value in factors.items():
        if abs(value) < SINGULAR:
            raise NoSolution(f'{name}: {value:.3g}, needs {SINGULAR:g} or more')
