"""How much of requested joint rates the joints can drive: speeds, stops, accelerations.

Rates are scaled as a whole, never one joint alone, so that the tool keeps its direction
(docs/arm-kinematics.md, 8). The formulas are in kernel/rate_scaling.c. Where no part of a twist
can be driven, there are rates that lead out (section 9).
"""

import itertools
from dataclasses import dataclass, field

import numpy as np

from arm_control.line_keeping import LOST, Posture
from manipulator import _kernel
from manipulator.arrays import Array, Mask, frozen

AT_STOP = 1e-4
"""Radians from its stop at which a joint stands there: 0.006°, finer than any of our drives."""
AT_ONCE = 1e12
"""1/s, for a twist that may fall as fast as the joints can brake."""
ROUNDING = 1e-6
"""Radians by which a jog stays off the end of each range: who solves its pose again for the joints
must not find one beyond."""
LIMITS = ('', 'speed', 'acceleration', 'stop')
"""What sets a scale, in the order of kernel/rate_scaling.h."""


@dataclass(frozen=True)
class Scale:
    """The part of requested rates that can be driven, and what set it, '' where all can.

    limit is 'speed', 'acceleration' or 'stop', joint counts from 1.
    """

    part: float
    limit: str = ''
    joint: int = 0

    def words(self, owners: tuple[str, ...]) -> str:
        """Of a limit: as in 'speed of joint 2'; owners are what the joints are called."""
        return f'{self.limit} of {owners[self.joint - 1]}'


@dataclass(frozen=True, eq=False)
class RateScaling:
    """The joints' limits, each (6,), in rad, rad/s and rad/s².

    low and high are given as the joints' ranges, and kept ROUNDING inside them, where a jog ends.
    numbers are these in the order of `struct joint_limits`.
    """

    low: Array
    high: Array
    speed: Array
    acceleration: Array
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepares what the kernel is given."""
        object.__setattr__(self, 'low', frozen(self.low + ROUNDING))
        object.__setattr__(self, 'high', frozen(self.high - ROUNDING))
        limits = self.low, self.high, self.speed, self.acceleration
        object.__setattr__(self, 'numbers', frozen(np.concatenate(limits)))

    def stops(self, joints: Array, within: float) -> tuple[Mask, Mask]:
        """Which of joints (6,) stand at the low ends of their ranges, and at the high ones."""
        return joints - self.low <= within, self.high - joints <= within

    def scale(
        self, rates: Array, bend: Array, joints: Array, dt: float, slowing: float = AT_ONCE
    ) -> Scale:
        """The part of `rates` that every joint can drive, and brake from before its stop.

        joints (6,) are where they are; bend (6,) in rad/s² is how `rates` change while the tool
        goes straight on with all of them.
        slowing: the part of itself (1/s) by which the rates may fall before a stop.
        """
        scale, time = np.empty(3), np.array((dt, slowing))
        _kernel.scale_rates(self.numbers, joints, rates, bend, time, scale)
        part, limit, joint = scale.tolist()
        return Scale(part, LIMITS[int(limit)], int(joint))

    def followed(
        self, before: Array, joints: Array, rates: Array, part: float, dt: float
    ) -> tuple[Array, Array]:
        """Rates (6,) that the accelerations allow after `before`, and joints (6,) dt later.

        On the way to part·rates they are a multiple of `rates`, the nearest to `part`, wherever
        one can be reached; else all joints go the same part of the way. Stops outrank
        accelerations: a step that would pass one is shortened as a whole.
        """
        after, there, going = before.copy(), joints.copy(), np.array((part, dt))
        _kernel.follow_rates(self.numbers, rates, going, after, there)
        return after, there


NEGLIGIBLE = 1e-9
"""Rates (rad/s per unit of twist) and accelerations that count as none."""


def blocked(unit_rates: Array, at_low: Mask, at_high: Mask) -> Mask:
    """Which of the twelve unit twists ±x … ±ωz (12,) press a joint onto its stop, or stand.

    unit_rates (6, 6) has the joint rates for +x … +ωz as its columns. Twists are scaled as a
    whole, so that one joint at a stop stops all; in a corner of the joint range this may leave
    none of the twelve.
    """
    either = np.concatenate([unit_rates, -unit_rates], axis=1)
    low = (either[at_low] < -NEGLIGIBLE).any(axis=0)
    high = (either[at_high] > NEGLIGIBLE).any(axis=0)
    return np.asarray(low | high | (np.abs(either).max(axis=0) < NEGLIGIBLE), dtype=np.bool_)


def sliding_rates(
    scaled_jacobian: Array, scaled_twist: Array, damping: float, at_low: Mask, at_high: Mask
) -> Array:
    """Joint rates (6,) with the twist nearest to the requested one that leave or keep every stop.

    Least squares |J q̇ − x|² + damping²·|q̇|², q̇ ≥ 0 at a low stop, ≤ 0 at a high one, exactly:
    the best admissible one over all ways of holding some of the stopped joints still. It is zero
    for all twelve unit twists only if J is zero, for J·q̇ ≠ 0 has a component along one of them.
    """
    stopped = np.flatnonzero(at_low | at_high)
    normal = scaled_jacobian.T @ scaled_jacobian + damping**2 * np.eye(6)
    projected = scaled_jacobian.T @ scaled_twist
    best, least = np.zeros(6), 0.0
    for held in itertools.product((False, True), repeat=len(stopped)):
        free = np.ones(6, dtype=np.bool_)
        free[stopped[list(held)]] = False
        rates = np.zeros(6)
        rates[free] = np.linalg.solve(normal[np.ix_(free, free)], projected[free])
        admissible = (rates[at_low] >= 0).all() and (rates[at_high] <= 0).all()
        cost = float(rates @ normal @ rates / 2 - projected @ rates)
        if admissible and cost < least:
            best, least = rates, cost
    return best


def folding_rates(
    posture: Posture, scaled_twist: Array, to_middle: Array, at_low: Mask, at_high: Mask
) -> Array:
    """Joint rates (6,) that begin to bend a lost joint so that the tool goes the requested way.

    At σ = 0 turning the joints along v does not move the tool, but accelerates it by J̇(v)·v, to
    the same side for v and −v: a stretched elbow bends inwards either way. The way is taken that
    leads to_middle (6,) of the joint ranges. Zeros where the twist leads to the other side.
    """
    lost = posture.sigma < LOST
    idle, beyond = (
        posture.right[lost],
        posture.left[:, lost] @ (scaled_twist @ posture.left[:, lost]),
    )
    pull, ways = np.linalg.eigh(_accelerations(posture, idle, beyond))
    if not pull.size or pull[-1] <= NEGLIGIBLE * float(beyond @ beyond) ** 0.5:
        return np.zeros(6)
    bend = ways[:, -1] @ idle
    for rates in (bend, -bend) if bend @ to_middle >= 0 else (-bend, bend):
        if not (rates[at_low] < -NEGLIGIBLE).any() and not (rates[at_high] > NEGLIGIBLE).any():
            return rates
    return np.zeros(6)


def _accelerations(posture: Posture, idle: Array, along: Array) -> Array:
    """How idle motions (k, 6) accelerate the tool `along` (6,): a quadratic form (k, k)."""

    def mean(a: Array, b: Array) -> float:
        return float((posture.turning(a + b) - posture.turning(a - b)) @ along) / 4

    return np.array([[mean(a, b) for b in idle] for a in idle]).reshape(len(idle), len(idle))
