"""A fast way along a path in the phase plane: two passes over squared path speeds.

On each interval of the path the acceleration is constant, so that the squares x and y of the
speed ṡ at its two ends fix it: s̈ = (y − x)/2Δ. Every limit is then a row A·x + B·y ≤ C, and one
of the two is eliminated: backwards the largest x from which y is not passed, forwards the largest
y. As in Pham, Pham 2018 (TOPP-RA, section VI), but no speed is allowed that could not be kept
(x = y): then one pass each way always succeeds. docs/motion.md, section 5.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array


@dataclass(frozen=True, eq=False)
class Rows:
    """k rows for each of m intervals: A·x + B·y ≤ C, arrays (m, k), every C > 0."""

    on_begin: Array
    on_end: Array
    bound: Array

    @property
    def highest_kept(self) -> Array:
        """The largest square at which the path's speed can stay on each interval, (m,)."""
        kept = self.on_begin + self.on_end
        is_bound = kept > 0
        ratio = np.where(is_bound, self.bound / np.where(is_bound, kept, 1.0), np.inf)
        return np.asarray(ratio.min(axis=1))


def fastest(rows: Rows, highest: Array) -> Array:
    """Squared speeds (m + 1,) from rest to rest, nowhere above `highest` (m + 1,)."""
    kept = rows.highest_kept
    best = highest.copy()
    best[:-1] = np.minimum(best[:-1], kept)
    best[1:] = np.minimum(best[1:], kept)
    best[0] = best[-1] = 0.0
    cap, gain = _solved(rows.on_begin, rows.on_end, rows.bound)
    for i in range(len(best) - 2, 0, -1):
        best[i] = min(best[i], (cap[i] + gain[i] * best[i + 1]).min())
    cap, gain = _solved(rows.on_end, rows.on_begin, rows.bound)
    for i in range(len(best) - 2):
        best[i + 1] = min(best[i + 1], (cap[i] + gain[i] * best[i]).min())
    return np.asarray(best, dtype=np.float64)


def _solved(wanted: Array, given: Array, bound: Array) -> tuple[Array, Array]:
    """Cap and gain: each wanted square ≤ cap + gain·(the given one); ∞ and 0 where not bound.

    A row that bounds both from above only restricts what `highest_kept` already does.
    """
    is_bound = (wanted > 0) & (given < 0)
    divisor = np.where(is_bound, wanted, 1.0)
    cap = np.where(is_bound, bound / divisor, np.inf)
    return cap, np.where(is_bound, -given / divisor, 0.0)
