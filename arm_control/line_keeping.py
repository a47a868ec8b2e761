"""Joint rates that keep the tool on its line near singularities (docs/arm-kinematics.md, 8).

They rest on the Jacobian at one moment, with its singular values, and name the singular posture
that an arm is near. The formulas are in kernel/line_keeping.c.
"""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import JOINTS, Chain
from arm_control.closed_forms import ParallelAxes, SphericalWrist
from arm_control.inverse_method import InverseMethod
from manipulator import _kernel
from manipulator.arrays import Array

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
    same column of `left`, σ times as fast. numbers are J, U, σ, Vᵀ (`struct decomposed`).
    """

    numbers: Array

    @classmethod
    def at(cls, chain: Chain, length: Array, joints: Array) -> 'Posture':
        """Decomposes the Jacobian at joints (6,); length (1,) in metres."""
        numbers = np.empty(3 * SQUARE + 6)
        _kernel.decompose(chain.numbers, length, joints, numbers)
        return cls(numbers)

    @property
    def jacobian(self) -> Array:
        """(6, 6)."""
        return self.numbers[:SQUARE].reshape(6, 6)

    @property
    def left(self) -> Array:
        """(6, 6), a column for each singular value."""
        return self.numbers[SQUARE : 2 * SQUARE].reshape(6, 6)

    @property
    def sigma(self) -> Array:
        """(6,), falling."""
        return self.numbers[2 * SQUARE : 2 * SQUARE + 6]

    @property
    def right(self) -> Array:
        """(6, 6), a row for each singular value."""
        return self.numbers[2 * SQUARE + 6 :].reshape(6, 6)

    @property
    def sigma_min(self) -> float:
        """How near to singular: the smallest singular value."""
        return float(self.numbers[2 * SQUARE + 5])

    def turning(self, rates: Array) -> Array:
        """The tool's acceleration (6,), scaled, at constant joint rates: J̇·q̇."""
        acceleration = np.empty(6)
        _kernel.turning(self.numbers, rates, acceleration)
        return acceleration

    def damped_rates(self, scaled_twists: Array, onset: Array) -> Array:
        """Joint rates (..., 6), their gain bounded to 1.3/onset: the tool may leave its line.

        Value and slope are continuous at the onset, and nothing is left at σ = 0 (numerical
        filtering after Maciejewski and Klein, Int. J. Robotics Research 7(6), 1988).
        """
        rates = np.empty(scaled_twists.shape)
        _kernel.damped_rates(self.numbers, onset, scaled_twists, rates)
        return rates


SQUARE = 36

LOST = 1e-6
"""σ below which a direction is lost altogether: no rates drive the tool along it."""
NOISE = 1e-9
"""Part of the fastest joint's rate below which another joint's is rounding."""


@dataclass(frozen=True, eq=False)
class LineRates:
    """What one scaled twist needs of the joints, per unit of it: numbers are `struct line`.

    rates (6,) in rad/s; bend (6,) in rad/s² is how they change while the tool goes straight on:
    scaled by s, the rates are s·rates and the bend s²·bend. along (6,) are the rates along the
    right singular vectors; is_lost: no rates at all drive the tool along the twist.
    """

    numbers: Array

    @property
    def rates(self) -> Array:
        """(6,), rad/s."""
        return self.numbers[:JOINTS]

    @property
    def bend(self) -> Array:
        """(6,), rad/s²."""
        return self.numbers[JOINTS : 2 * JOINTS]

    @property
    def is_lost(self) -> bool:
        """Whether no rates drive the tool along the twist."""
        return bool(self.numbers[-1])

    @property
    def direction(self) -> int:
        """The index of the singular value that needs most of the rates."""
        return int(np.abs(self.numbers[2 * JOINTS : -1]).argmax())

    @property
    def growth(self) -> float:
        """By which part of themselves (1/s) the rates grow while the tool goes straight on.

        It is positive on the way into a singular posture, negative on the way out.
        """
        size = float(self.rates @ self.rates)
        return float(self.rates @ self.bend) / size if size > 0.0 else 0.0


def line_rates(
    posture: Posture, scaled_twist: Array, onset: Array, off_line: Array | None = None
) -> LineRates:
    """Undamped rates for a twist and back to its line; `off_line` (6,), scaled, is the way there.

    Along directions whose σ is below `onset` (1,), a little of the twist may be missing: what
    passes a singular posture almost beside the lost direction is not held up by the little that
    is lost. Without `off_line` they are for the twist and nothing else: those for its opposite
    are their opposites.
    """
    numbers = np.empty(3 * JOINTS + 1)
    _kernel.line_rates(posture.numbers, onset, scaled_twist, off_line, numbers)
    return LineRates(numbers)


def without_noise(rates: Array) -> Array:
    """`rates` with rounding set to zero, or a joint at its stop would hold the arm for nothing."""
    size = np.abs(rates)
    return np.where(size < NOISE * max(size.tolist()), 0.0, rates)
