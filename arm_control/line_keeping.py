"""Joint rates that keep the tool on its line near singularities (docs/arm-kinematics.md, 8)."""

from dataclasses import dataclass

import numpy as np

from arm_control.posture import Posture
from manipulator.arrays import Array, Mask

LET_GO = 0.003
"""Part of a twist that may be missing in a direction that is being lost."""
PULL = 10.0
"""1/s: the gain with which a tool off its line is pulled back,"""
MOST_PULL = 0.2
"""by no more than this part of the twist: a tool that stands is not moved."""
LOST = 1e-6
"""σ below which a direction is lost altogether: no rates drive the tool along it."""
NOISE = 1e-9
"""Part of the fastest joint's rate below which another joint's is rounding."""


@dataclass(frozen=True, eq=False)
class LineRates:
    """What one scaled twist needs of the joints, per unit of it.

    rates (6,) in rad/s; bend (6,) in rad/s² is how they change while the tool goes straight on:
    scaled by s, the rates are s·rates and the bend s²·bend. along (6,) are the rates along the
    right singular vectors; is_lost: no rates at all drive the tool along the twist.
    """

    rates: Array
    bend: Array
    along: Array
    is_lost: bool

    @property
    def direction(self) -> int:
        """The index of the singular value that asks for most of the rates."""
        return int(np.abs(self.along).argmax())

    @property
    def growth(self) -> float:
        """By which part of themselves (1/s) the rates grow while the tool goes straight on.

        It is positive on the way into a singular posture, negative on the way out.
        """
        size = float(self.rates @ self.rates)
        return float(self.rates @ self.bend) / size if size > 0.0 else 0.0


def line_rates(posture: Posture, scaled_twist: Array, off_line: Array, onset: float) -> LineRates:
    """Undamped rates for a twist and back to its line; `off_line` (6,), scaled, is the way there.

    Along directions whose σ is below `onset`, LET_GO of the twist may be missing: what passes a
    singular posture almost beside the lost direction is not held up by the little that is lost. A
    tool that is LET_GO/PULL seconds of its way off the line is pulled back by as much.
    """
    back = _pull(off_line, scaled_twist)
    if posture.sigma_min >= onset:
        return _rates(posture, (scaled_twist + back) @ posture.left)
    parts, back = scaled_twist @ posture.left, back @ posture.left
    # The pull never turns a lost direction around: the way back must stay open.
    back = np.where((posture.sigma < onset) & (back * parts < 0.0), 0.0, back)
    size = float(scaled_twist @ scaled_twist) ** 0.5
    let_go = LET_GO * size * np.maximum(1.0 - posture.sigma / onset, 0.0)
    parts = parts + back
    kept = np.maximum(np.abs(parts) - let_go, 0.0)
    return _rates(posture, np.copysign(kept, parts), is_let_go=kept == 0.0)


def exact_rates(posture: Posture, scaled_twist: Array) -> LineRates:
    """Rates for the twist and nothing else: those for its opposite are their opposites."""
    return _rates(posture, scaled_twist @ posture.left)


def _rates(posture: Posture, parts: Array, is_let_go: Mask | None = None) -> LineRates:
    """For the twist's parts (6,) along the left singular vectors; some may be let go of."""
    sigma, is_lost = posture.sigma, False
    if posture.sigma_min < LOST:
        lost = sigma < LOST
        sigma = np.where(lost, np.inf, sigma)
        is_lost = bool((np.abs(parts[lost]) > NOISE * np.abs(parts).max()).any())
    along = parts / sigma
    rates = without_noise(along @ posture.right)
    bends = posture.turning(rates) @ posture.left
    if is_let_go is not None:
        bends[is_let_go] = 0.0
    if is_lost:
        along = parts / np.maximum(posture.sigma, LOST)
    return LineRates(rates, -(bends / sigma) @ posture.right, along, is_lost)


def _pull(off_line: Array, scaled_twist: Array) -> Array:
    off = float(off_line @ off_line) ** 0.5
    if off == 0.0:
        return off_line
    most = MOST_PULL * float(scaled_twist @ scaled_twist) ** 0.5
    back: Array = min(PULL, most / off) * off_line
    return back


def without_noise(rates: Array) -> Array:
    """`rates` with rounding set to zero, or a joint at its stop would hold the arm for nothing."""
    size = np.abs(rates)
    return np.where(size < NOISE * max(size.tolist()), 0.0, rates)
