"""The way out where joints stand at their stops (docs/arm-kinematics.md, 9)."""

import itertools

import numpy as np

from arm_control.damping import DampedInverse
from manipulator.arrays import Array, Mask

NEGLIGIBLE = 1e-9


def is_dead(inverse: DampedInverse, at_low: Mask, at_high: Mask) -> bool:
    """Whether each of the twelve unit twists ±x … ±ωz presses a joint onto its stop, or stands.

    Twists are scaled as a whole, so that one joint at a stop stops all; in a corner of the joint
    range this may leave none of the twelve.
    """
    rates = inverse.unit_rates()
    either = np.concatenate([rates, -rates], axis=1)
    blocked = (either[at_high] > NEGLIGIBLE).any(axis=0) | (either[at_low] < -NEGLIGIBLE).any(
        axis=0
    )
    stands = np.abs(either).max(axis=0) < NEGLIGIBLE
    return bool((blocked | stands).all())


def sliding_rates(
    scaled_jacobian: Array, scaled_twist: Array, damping: float, at_low: Mask, at_high: Mask
) -> Array:
    """Joint rates (6,) with the twist nearest to the wanted one that leave or keep every stop.

    Least squares |J q̇ − x|² + damping²·|q̇|², q̇ ≥ 0 at a low stop, ≤ 0 at a high one, exactly:
    the best admissible one over all ways of holding some of the stopped joints still. It is zero
    for all twelve unit twists only if J is zero, for J·q̇ ≠ 0 has a component along one of them.
    """
    stopped = np.flatnonzero(at_low | at_high)
    normal = scaled_jacobian.T @ scaled_jacobian + damping**2 * np.eye(6)
    wanted = scaled_jacobian.T @ scaled_twist
    best, least = np.zeros(6), 0.0
    for held in itertools.product((False, True), repeat=len(stopped)):
        free = np.ones(6, dtype=np.bool_)
        free[stopped[list(held)]] = False
        rates = np.zeros(6)
        rates[free] = np.linalg.solve(normal[np.ix_(free, free)], wanted[free])
        admissible = (rates[at_low] >= 0).all() and (rates[at_high] <= 0).all()
        cost = float(rates @ normal @ rates / 2 - wanted @ rates)
        if admissible and cost < least:
            best, least = rates, cost
    return best
