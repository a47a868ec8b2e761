"""Joint rates that keep the tool on its line near singularities (docs/arm-kinematics.md, 8).

They rest on the Jacobian at one moment, with its singular values, and name the singular posture
that an arm is near.
"""

from dataclasses import dataclass

import numpy as np

from arm_control.closed_forms import ParallelAxes, SphericalWrist
from arm_control.inverse_method import InverseMethod
from manipulator.arrays import Array, Mask

TAKES_PART = 0.3
"""Of the fastest joint's rate, from which on another one takes part in an idle motion."""

SHOULDER = 'shoulder singularity (wrist on the axis of joint 1)'
ELBOW = 'elbow singularity (arm stretched or folded)'
WRIST = 'wrist singularity (axes of joints 4 and 6 in line)'
WRIST_PARALLEL = 'wrist singularity (axis of joint 6 parallel to that of joint 4)'


def singularity(method: InverseMethod, idle: Array) -> str:
    """The singularity by the joint motion (6,) that least moves the tool there.

    Arms without a spherical wrist or three parallel axes have no such names: the joints that
    cancel each other are listed.
    """
    ideal = method.form
    parts = np.abs(idle) >= TAKES_PART * np.abs(idle).max()
    if isinstance(ideal, SphericalWrist | ParallelAxes) and parts[0]:
        return SHOULDER
    if isinstance(ideal, SphericalWrist):
        return ELBOW if parts[1:3].any() else WRIST
    if isinstance(ideal, ParallelAxes):
        return WRIST_PARALLEL if parts[5] else ELBOW
    *most, last = (str(i) for i in np.flatnonzero(parts) + 1)
    return f'singular posture (joints {", ".join(most)} and {last} cancel each other)'


@dataclass(frozen=True, eq=False)
class Posture:
    """J = U·Σ·Vᵀ (6, 6), with metres divided by the arm's characteristic length.

    Rows of `right` are the columns of V: turning the joints along one moves the tool along the
    same column of `left`, σ times as fast.
    """

    jacobian: Array
    left: Array
    sigma: Array
    right: Array

    @classmethod
    def of(cls, scaled_jacobian: Array) -> 'Posture':
        """Decomposes one scaled Jacobian."""
        left, sigma, right = np.linalg.svd(scaled_jacobian)
        return cls(scaled_jacobian, left, sigma, right)

    @property
    def sigma_min(self) -> float:
        """How near to singular: the smallest singular value."""
        return float(self.sigma[-1])

    def turning(self, rates: Array) -> Array:
        """The tool's acceleration (6,), scaled, at constant joint rates: J̇·q̇.

        With the columns (v_j, a_j): Σ (Ω_j + Ω_{j−1}) × v_j q̇_j and Σ Ω_{j−1} × a_j q̇_j, where
        Ω_j = Σ_{k≤j} a_k q̇_k is the angular velocity of link j.
        """
        moving = self.jacobian * rates
        links = np.cumsum(moving[3:], axis=1)
        before = links - moving[3:]
        linear = (links + before) @ moving[:3].T
        angular = before @ moving[3:].T
        return np.array([*_cross(linear), *_cross(angular)])

    def damped_rates(self, scaled_twist: Array, onset: float) -> Array:
        """Joint rates (6,), their gain bounded to 1.3/onset: the tool may leave its line."""
        result: Array = (self._gains(onset) * (scaled_twist @ self.left)) @ self.right
        return result

    def damped_unit_rates(self, onset: float) -> Array:
        """Damped joint rates for each unit twist, as the columns of (6, 6)."""
        result: Array = (self.right.T * self._gains(onset)) @ self.left.T
        return result

    def _gains(self, onset: float) -> Array:
        """1/σ down to `onset` ε, below it 4σε² / (ε² + σ²)².

        That is the damped σ / (σ² + λ²) with λ = (ε/2)·(1 − (σ/ε)²), so that value and slope are
        continuous, and nothing is left at σ = 0 (numerical filtering after Maciejewski and Klein,
        Int. J. Robotics Research 7(6), 1988).
        """
        sigma = self.sigma
        damped = 4 * sigma * onset**2 / (onset**2 + sigma**2) ** 2
        return np.where(sigma < onset, damped, 1.0 / np.maximum(sigma, onset))


def _cross(products: Array) -> tuple[float, float, float]:
    """Σ a_j × b_j, from Σ a_j·b_jᵀ (3, 3)."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = products.tolist()
    return yz - zy, zx - xz, xy - yx


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
