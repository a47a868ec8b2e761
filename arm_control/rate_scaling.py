"""How much of wanted joint rates the joints can drive: speeds, stops, accelerations.

Rates are scaled as a whole, never one joint alone, so that the tool keeps its direction
(docs/arm-kinematics.md, 8).

The ways out where a twist cannot be kept to (docs/arm-kinematics.md, 9).
"""

import itertools
from dataclasses import dataclass

import numpy as np

from arm_control.line_keeping import LOST, Posture
from manipulator.arrays import Array, Mask

AT_STOP = 1e-4
"""Radians from its stop at which a joint stands there: 0.006°, finer than any of our drives."""
STANDING = 1e-9
"""rad/s."""
AT_ONCE = 1e12
"""1/s, for a twist that may fall as fast as the joints can brake."""
ROUNDING = 1e-6
"""Radians by which a jog stays off the end of each range: who solves its pose again for the joints
must not find one beyond it."""
BEND_SHARE = 0.25
"""Of a joint's acceleration, what following a straight line at constant speed may take; the rest
is left for braking on it."""
BRAKING_LEFT = 0.1
"""Of a joint's braking, what is counted on where the line takes most of it."""
STRAIGHT = 1e-12
"""rad/s²."""
FAR = 1e12
"""Radians or rad/s that hold nothing back."""


@dataclass(frozen=True, eq=False)
class Room:
    """Radians (6,) from each joint to both ends of its range; negative beyond."""

    to_low: Array
    to_high: Array

    def ahead(self, rates: Array) -> Array:
        """To the ends that `rates` lead to."""
        return np.where(rates > 0, self.to_high, self.to_low)


@dataclass(frozen=True)
class Scale:
    """The part of wanted rates that can be driven, and what set it, '' where all can.

    limit is 'speed', 'acceleration' or 'stop', joint counts from 1.
    """

    part: float
    limit: str = ''
    joint: int = 0

    def __str__(self) -> str:
        """As in 'speed of joint 2'."""
        return f'{self.limit} of joint {self.joint}' if self.limit else ''


@dataclass(frozen=True, eq=False)
class RateScaling:
    """The joints' limits, each (6,), in rad, rad/s and rad/s²."""

    low: Array
    high: Array
    speed: Array
    acceleration: Array

    def room(self, joints: Array) -> Room:
        """What is left of the ranges, less ROUNDING."""
        return Room(joints - self.low - ROUNDING, self.high - ROUNDING - joints)

    def scale(
        self, rates: Array, bend: Array, room: Room, dt: float, slowing: float = AT_ONCE
    ) -> Scale:
        """The part of `rates` that every joint can drive, and brake from before its stop.

        bend (6,) in rad/s² is how `rates` change while the tool goes straight on with all of them.
        slowing: the part of itself (1/s) by which the rates may fall before a stop.
        """
        size = np.maximum(np.abs(rates), STANDING)
        driven = (self.speed / size).tolist()
        bent = self._bent(bend)
        fastest, easiest = min(driven), min(bent)
        cruise = min(1.0, fastest, easiest)
        speeds = self._braking_speeds(rates, size, cruise**2 * bend, room, dt, slowing)
        braked = (speeds / size).tolist()
        gentlest = min(braked)
        if min(cruise, gentlest) >= 1.0:
            return Scale(1.0)
        if gentlest < cruise:
            return Scale(gentlest, 'stop', braked.index(gentlest) + 1)
        if easiest < fastest:
            return Scale(easiest, 'acceleration', bent.index(easiest) + 1)
        return Scale(fastest, 'speed', driven.index(fastest) + 1)

    def _bent(self, bend: Array) -> list[float]:
        """The part of the rates at which each joint can follow their bend."""
        squares = BEND_SHARE * self.acceleration / np.maximum(np.abs(bend), STRAIGHT)
        result: list[float] = np.sqrt(squares).tolist()
        return result

    def _braking_speeds(
        self, rates: Array, size: Array, bend: Array, room: Room, dt: float, slowing: float
    ) -> Array:
        """From what speed (6,) each joint can stand before its stop, all braking together.

        With deceleration a and room r: v·dt + v²/(2a) ≤ r. All joints fall by the same part of
        themselves, as fast as the one that brakes worst; what its line bends towards the stop, a
        joint has to brake as well. Joints that stand may be anywhere.
        """
        fall = min(slowing, *((self.acceleration - np.abs(bend)) / size).tolist())
        most = fall * size
        a = np.maximum(
            most - np.maximum(np.copysign(bend, rates * bend), 0.0), BRAKING_LEFT * most
        )
        ahead = room.ahead(rates)
        ahead[ahead <= AT_STOP] = 0.0
        slowed = a * dt
        speeds: Array = np.sqrt(slowed * slowed + 2 * a * ahead) - slowed
        speeds[size <= STANDING] = FAR
        return speeds

    def followed(self, before: Array, rates: Array, part: float, room: Room, dt: float) -> Array:
        """Rates (6,) that the accelerations allow after `before`, on the way to part·rates.

        They are a multiple of `rates`, the nearest to `part`, wherever one can be reached; else
        all joints go the same part of the way. Stops outrank accelerations: a step that would pass
        one is shortened as a whole.
        """
        size, gain = np.maximum(np.abs(rates), STANDING), self.acceleration * dt
        now, reach = np.copysign(before, before * rates) / size, gain / size
        least, most = max((now - reach).tolist()), min((now + reach).tolist())
        chosen = min(max(part, least), most) * rates
        if least > most or most < 0 or max((np.abs(chosen) - self.speed).tolist()) > STANDING:
            change = part * rates - before
            chosen = before + change / max(1.0, *(np.abs(change) / gain).tolist())
        size = np.abs(chosen)
        chosen[size < STANDING] = 0.0
        ahead = np.maximum(room.ahead(chosen), 0.0)
        ahead[size < STANDING] = FAR
        parts = ahead / np.maximum(size, STANDING)
        shortened: Array = chosen * min(1.0, *(parts / dt).tolist())
        return shortened

    def stepped(self, joints: Array, rates: Array, dt: float) -> Array:
        """Joints (6,) dt later; only rounding is cut off, what stops do is in `rates`."""
        highest = np.maximum(self.high - ROUNDING, joints)
        lowest = np.minimum(self.low + ROUNDING, joints)
        result: Array = np.minimum(np.maximum(joints + dt * rates, lowest), highest)
        return result


NEGLIGIBLE = 1e-9


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


def folding_rates(
    posture: Posture, scaled_twist: Array, to_middle: Array, at_low: Mask, at_high: Mask
) -> Array:
    """Joint rates (6,) that begin to bend a lost joint so that the tool goes the wanted way.

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
