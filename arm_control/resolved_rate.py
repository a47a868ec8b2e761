"""One jog tick: from the wanted twist to the next joint angles (docs/arm-kinematics.md, 7 to 9).

The wanted twist is scaled as a whole, never one joint alone, so that the tool keeps its direction.
"""

from dataclasses import dataclass, field

import numpy as np

from arm_control.arm import SerialArm
from arm_control.corner import is_dead, sliding_rates
from arm_control.damping import DampedInverse
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.motion_limits import MotionLimits

AT_STOP = 1e-4
"""Radians from its stop at which a joint stands there: 0.006°, finer than any of our drives."""
CORNER = 0.05
"""Radians from its stop at which a joint counts as part of a corner."""
NOISE = 1e-9
"""Part of the fastest joint's rate below which another joint's is rounding."""
STANDING = 1e-9
"""rad/s."""
AT_ONCE = 1e12
"""1/s, for a twist that may fall as fast as the joints can brake."""
ROUNDING = 1e-6
"""Radians by which a jog stays off the end of each range: who solves its pose again for the joints
must not find one beyond it."""


@dataclass(frozen=True, eq=False)
class JogState:
    """Joint angles and rates (6,), in rad and rad/s."""

    joints: Array
    rates: Array

    @classmethod
    def at_rest(cls, joints: Array) -> 'JogState':
        """Standing at `joints`; raises InvalidInput unless they are six finite numbers."""
        values = frozen(joints)
        if values.shape != (6,) or not np.isfinite(values).all():
            raise InvalidInput(f'joints are {values.tolist()}, needs six finite angles')
        return cls(values, frozen(np.zeros(6)))


@dataclass(frozen=True)
class JogStep:
    """What one tick came to.

    scale is the part of the wanted twist that the joints allow (1 when nothing holds it back),
    held_by what set it: '', 'speed of joint 2', 'stop of joint 3', or 'corner' where the arm
    slides out of a corner of its range in the nearest possible direction. sigma_min below the
    damping onset means that motion is damped.
    """

    state: JogState
    scale: float
    held_by: str
    sigma_min: float


@dataclass(frozen=True, eq=False)
class ResolvedRate:
    """Steps an arm within its joint limits; `onset` is the σ below which motion is damped.

    The twist's own speed limits are the business of manipulator/teleop/speed_limits.py.
    """

    arm: SerialArm
    motion: MotionLimits
    onset: float
    _unit: Array = field(init=False, repr=False)
    _speed: Array = field(init=False, repr=False)
    _acceleration: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Combines the joints' own limits with the machine's."""
        joint = self.motion.joint.tightened(self.arm.limits.speed, self.arm.limits.acceleration)
        unit = np.array([1 / self.arm.characteristic_length] * 3 + [1.0] * 3)
        for name, value in (
            ('_unit', frozen(unit)),
            ('_speed', joint.speed),
            ('_acceleration', joint.acceleration),
        ):
            object.__setattr__(self, name, value)

    def step(self, state: JogState, twist: Array, dt: float, slowing: float = AT_ONCE) -> JogStep:
        """The state dt seconds later, for a twist (6,) of the tool in base axes.

        slowing: the part of itself (1/s) by which the twist may fall before a stop. Joints that
        could brake harder begin earlier.
        Raises InvalidInput for a twist or dt that is not finite or not positive.
        """
        wanted = np.asarray(twist, dtype=np.float64)
        if wanted.shape != (6,) or not np.isfinite(wanted).all() or not 0 < dt < np.inf:
            raise InvalidInput(f'twist {wanted.tolist()} over {dt} s, needs six finite, positive')
        midway = state.joints + 0.5 * dt * state.rates
        scaled_jacobian = self.arm.chain.jacobian(midway) * self._unit[:, None]
        scaled_twist = wanted * self._unit
        inverse = DampedInverse.of(scaled_jacobian, self.onset)
        rates, to_high, to_low = _without_noise(inverse.rates(scaled_twist)), *self._room(state)
        scale, held_by = self._scale(rates, to_high, to_low, dt, slowing)
        if scale == 0.0:
            near_singular = inverse.sigma_min < self.onset
            if near_singular or is_dead(inverse, to_low <= CORNER, to_high <= CORNER):
                stops = to_low <= AT_STOP, to_high <= AT_STOP
                slide = sliding_rates(scaled_jacobian, scaled_twist, 0.5 * self.onset, *stops)
                rates, held_by = _without_noise(slide), 'corner'
                scale, _ = self._scale(rates, to_high, to_low, dt, slowing)
        following = self._followed(state.rates, scale * rates, to_high, to_low, dt)
        # Only rounding is cut off here: what the stops do is in `following` already.
        highest = np.maximum(self.arm.limits.high - ROUNDING, state.joints)
        lowest = np.minimum(self.arm.limits.low + ROUNDING, state.joints)
        joints = np.minimum(np.maximum(state.joints + dt * following, lowest), highest)
        after = JogState(frozen(joints), frozen(following))
        return JogStep(after, scale, held_by, inverse.sigma_min)

    def _room(self, state: JogState) -> tuple[Array, Array]:
        high, low = self.arm.limits.high - ROUNDING, self.arm.limits.low + ROUNDING
        return high - state.joints, state.joints - low

    def _scale(
        self, rates: Array, to_high: Array, to_low: Array, dt: float, slowing: float
    ) -> tuple[float, str]:
        """The part of `rates` that every joint can drive, and brake before its stop.

        A joint at rate v with room r can brake when v·dt + v²/(2a) ≤ r.
        """
        room = np.where(rates > 0, to_high, to_low)
        room = np.where(room <= AT_STOP, 0.0, room)
        a = np.minimum(self._acceleration, slowing * np.abs(rates))
        braking = np.sqrt((a * dt) ** 2 + 2 * a * room) - a * dt
        allowed = np.minimum(self._speed, braking)
        parts = allowed / np.maximum(np.abs(rates), STANDING)
        parts[np.abs(rates) < STANDING] = 1.0
        tightest = int(parts.argmin())
        scale = float(parts[tightest])
        if scale >= 1.0:
            return 1.0, ''
        what = 'stop' if braking[tightest] < self._speed[tightest] else 'speed'
        return scale, f'{what} of joint {tightest + 1}'

    def _followed(
        self, before: Array, wanted: Array, to_high: Array, to_low: Array, dt: float
    ) -> Array:
        """Rates on the way from `before` to `wanted`, as far as the accelerations allow.

        All joints go the same part of the way, so that the tool's twist does too. Stops outrank
        accelerations: a step that would pass one is shortened as a whole.
        """
        change = wanted - before
        part = float((self._acceleration * dt / np.maximum(np.abs(change), STANDING)).min())
        rates = wanted if part >= 1.0 else before + part * change
        size = np.abs(rates)
        rates = np.where(size < STANDING, 0.0, rates)
        room = np.maximum(np.where(rates > 0, to_high, to_low), 0.0)
        parts = np.where(size < STANDING, 1.0, room / (dt * np.maximum(size, STANDING)))
        return rates * min(1.0, float(parts.min()))


def _without_noise(rates: Array) -> Array:
    """`rates` with rounding set to zero, or a joint at its stop would hold the arm for nothing."""
    size = np.abs(rates)
    return np.where(size < NOISE * size.max(), 0.0, rates)
