"""One jog tick: from a twist to the next joint angles (docs/arm-kinematics.md, 7 to 9)."""

import math
from dataclasses import dataclass, field

import numpy as np

from arm_control.arm import SerialArm
from arm_control.line_keeping import (
    LOST,
    LineRates,
    Posture,
    line_rates,
    singularity,
    without_noise,
)
from arm_control.rate_scaling import (
    AT_ONCE,
    AT_STOP,
    RateScaling,
    Scale,
    blocked,
    folding_rates,
    sliding_rates,
)
from manipulator import _kernel
from manipulator.arrays import Array, Mask, frozen
from manipulator.errors import InvalidInput
from manipulator.motion_limits import MotionLimits
from manipulator.teleop.jogger import ON_LINE, STRAIGHT, LineState

CORNER = 0.05
"""Radians from its stop at which a joint counts as part of a corner."""
SLOWEST = 0.01
"""Part of a twist, slower than which the tool does not creep on into a singular posture."""
MOST_GROWTH = 0.5
"""Part of themselves by which the joints' rates may grow within a tick."""
LEFT = 0.25
"""Of the damping onset: the σmin at which a singular posture has been left."""
AHEAD = 0.1
"""Radians of the fastest joint, over which a motion out of a singular posture must show."""
SHARE = 0.2
"""Of what the best single joint gains, that such a motion must gain."""
ENDLESS = 1e3
"""Radians to the end of a range that count as endless."""
SLIDING = 'sliding off the line: '
JOINT_CORNER = 'corner of the joint ranges'


@dataclass(frozen=True, eq=False)
class JogState:
    """Joint angles and rates (6,), in rad and rad/s, and the tool beside its line."""

    joints: Array
    rates: Array
    line: LineState = ON_LINE

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

    scale is the part of the requested twist that the joints allow (1 when nothing holds it back),
    held_by what set it: '', 'speed of joint 2', 'stop of joint 3', the singularity ahead, or
    SLIDING and where. driven is the part of the twist that the tool goes with by now, twist (6,)
    is the tool's own, in base axes; where it slides, only what of it is requested.
    """

    state: JogState
    scale: float
    held_by: str
    sigma_min: float
    driven: float
    twist: Array


@dataclass(frozen=True, eq=False)
class _Drive:
    """Joint rates (6,), the part of them that may be driven, and what sets it."""

    rates: Array
    scale: float
    held_by: str
    is_sliding: bool = False
    is_leaving: bool = False


@dataclass(frozen=True, eq=False)
class ResolvedRate:
    """Steps an arm within its joint limits.

    Near a singular posture (σ below `onset`) the tool keeps to its commanded line and stops where
    it cannot. Where `slides`, its motion is damped there instead, and bends off the line. The
    twist's own speed limits are the business of manipulator/teleop/jogger.py.
    """

    arm: SerialArm
    motion: MotionLimits
    onset: float
    slides: bool = False
    scaling: RateScaling = field(init=False, repr=False)
    _unit: Array = field(init=False, repr=False)
    _length: Array = field(init=False, repr=False)
    _onset: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Combines the joints' own limits with the machine's."""
        limits = self.arm.limits
        joint = self.motion.joint.tightened(limits.speed, limits.acceleration)
        scaling = RateScaling(limits.low, limits.high, joint.speed, joint.acceleration)
        length = self.arm.characteristic_length
        object.__setattr__(self, 'scaling', scaling)
        object.__setattr__(self, '_unit', frozen([1 / length] * 3 + [1.0] * 3))
        object.__setattr__(self, '_length', frozen([length]))
        object.__setattr__(self, '_onset', frozen([self.onset]))

    def step(self, state: JogState, twist: Array, dt: float, slowing: float = AT_ONCE) -> JogStep:
        """The state dt seconds later, for a twist (6,) of the tool in base axes.

        slowing: the part of itself (1/s) by which the twist may fall before a stop. Joints that
        could brake harder begin earlier.
        Raises InvalidInput for a twist or dt that is not finite or not positive.
        """
        requested = np.asarray(twist, dtype=np.float64)
        is_finite = requested.shape == (6,) and math.isfinite(math.hypot(*requested.tolist()))
        if not is_finite or not 0 < dt < math.inf:
            raise InvalidInput(
                f'twist {requested.tolist()} over {dt} s: needs six finite numbers and a '
                'positive time'
            )
        tick = _Tick(self, state, requested * self._unit, dt, slowing)
        drive = tick.damped() if self.slides else tick.on_line()
        if drive.scale == 0.0 and requested.any():
            drive = tick.way_out() or drive
        before = state.rates, state.joints
        rates, joints = self.scaling.followed(*before, drive.rates, drive.scale, dt)
        off_line, driven, moving = tick.missed(rates)
        if drive.is_sliding:
            off_line, moving = STRAIGHT, driven * requested
        is_leaving = drive.is_leaving or (state.line.is_leaving and tick.is_singular)
        is_moving = any(rates.tolist())
        is_on_line = is_moving and not (drive.is_sliding or is_leaving)
        is_driven = is_moving or bool(requested.any())
        is_under_way = is_on_line or (state.line.is_under_way and is_driven)
        for array in (joints, rates, off_line, moving):
            array.setflags(write=False)
        after = JogState(joints, rates, LineState(off_line, is_leaving, is_under_way))
        held = drive.scale, drive.held_by, tick.sigma_min
        return JogStep(after, *held, driven, moving)

    def damped_rates(self, joints: Array, twist: Array) -> Array:
        """Joint rates (6,) of the tool's twist (6,), base axes, damped near singular postures."""
        return self.posture(joints).damped_rates(twist * self._unit, self._onset)

    def posture(self, joints: Array) -> Posture:
        """The Jacobian at joints (6,), its linear velocities in characteristic lengths."""
        return Posture.at(self.arm.chain, self._length, joints)


class _Tick:
    """One step's posture and what can be driven from it; `twist` is scaled."""

    def __init__(
        self, jog: ResolvedRate, state: JogState, twist: Array, dt: float, slowing: float
    ) -> None:
        self.posture = jog.posture(state.joints + 0.5 * dt * state.rates)
        self.sigma_min = self.posture.sigma_min
        self._jog, self._state, self._twist = jog, state, twist
        self._dt, self._slowing = dt, slowing

    @property
    def is_singular(self) -> bool:
        """Whether a singular posture has not been left yet."""
        return self.sigma_min < LEFT * self._jog.onset

    def on_line(self) -> _Drive:
        """The twist with its direction kept, as far as the joints allow."""
        off_line = self._state.line.off_line * self._jog._unit
        line = line_rates(self.posture, self._twist, self._jog._onset, off_line)
        drive = self._scaled(line)
        if drive.scale > 0.0 or self.sigma_min >= self._jog.onset:
            return drive
        # Nothing but the twist: where it is stopped, its opposite is not.
        exact = self._scaled(self._exact(self._twist))
        return exact if exact.scale > 0.0 else drive

    def damped(self) -> _Drive:
        """The twist with its lost directions damped."""
        rates = self.posture.damped_rates(self._twist, self._jog._onset)
        scale = self._scale(rates, STRAIGHT)
        if self.sigma_min >= self._jog.onset:
            return _Drive(rates, scale.part, self._words(scale))
        return _Drive(rates, scale.part, SLIDING + self._place(), is_sliding=True)

    def way_out(self) -> _Drive | None:
        """Motion off the line where nothing else is left; None where there is a better twist."""
        sigma = self.sigma_min
        if self._jog.slides and sigma < self._jog.onset:
            return self._sliding(self._place())
        found = self._folding() if sigma < LOST else None
        if found or self._state.line.is_under_way:
            return found
        if sigma < LOST or (self._state.line.is_leaving and self.is_singular):
            found = self._leaving()
        return found or (self._sliding(JOINT_CORNER) if self._is_trapped() else None)

    def missed(self, rates: Array) -> tuple[Array, float, Array]:
        """How far (6,) the tool is off its line, its part of the twist (0 to 1), its own twist."""
        off_line, part, moving = self._state.line.off_line.copy(), np.empty(1), np.empty(6)
        time = np.array((self._jog.arm.characteristic_length, self._dt))
        _kernel.part_driven(self.posture.numbers, time, self._twist, rates, off_line, part, moving)
        return off_line, float(part[0]), moving

    def _exact(self, twist: Array) -> LineRates:
        return line_rates(self.posture, twist, self._jog._onset)

    def _scale(self, rates: Array, bend: Array) -> Scale:
        joints = self._state.joints
        return self._jog.scaling.scale(rates, bend, joints, self._dt, self._slowing)

    def _scaled(self, line: LineRates) -> _Drive:
        scale = self._scale(line.rates, line.bend)
        if self.sigma_min >= self._jog.onset:
            return _Drive(line.rates, scale.part, self._words(scale))
        if line.is_lost or (scale.limit != 'stop' and self._is_too_near(scale.part, line.growth)):
            return _Drive(line.rates, 0.0, self._place(line.direction))
        is_bent = scale.limit == 'acceleration'
        held_by = self._place(line.direction) if is_bent else self._words(scale)
        return _Drive(line.rates, scale.part, held_by)

    def _words(self, scale: Scale) -> str:
        return scale.words(self._jog.arm.limits.owners) if scale.limit else ''

    def _is_too_near(self, part: float, growth: float) -> bool:
        """Whether a singular posture ahead leaves only creep, or is about to be stepped over."""
        return growth > 0.0 and (part < SLOWEST or part * growth * self._dt > MOST_GROWTH)

    def _place(self, direction: int = -1) -> str:
        return singularity(self._jog.arm.method, self.posture.right[direction])

    def _folding(self) -> _Drive | None:
        """The beginning of a lost joint's bend that leads along the line."""
        joints, scaling = self._state.joints, self._jog.scaling
        to_low, to_high = np.fmin((joints - scaling.low, scaling.high - joints), ENDLESS)
        stops = scaling.stops(joints, AT_STOP)
        rates = folding_rates(self.posture, self._twist, to_high - to_low, *stops)
        if not rates.any():
            return None
        fastest = float((scaling.speed / np.maximum(np.abs(rates), LOST)).min())
        return _Drive(rates, fastest, self._place())

    def _leaving(self) -> _Drive | None:
        """Sliding out of a singular posture; None where it would lead along it."""
        drive = self._sliding(self._place(), is_leaving=True)
        gained = self._gained(drive.rates)
        if gained <= LOST:
            return None
        best = max(self._gained(joint) for joint in np.eye(6))
        return drive if gained >= SHARE * best else None

    def _gained(self, rates: Array) -> float:
        """By how much the σ below the damping onset rise, all together, over AHEAD of `rates`."""
        step = AHEAD * rates / max(float(np.abs(rates).max()), LOST)
        ahead, onset = self._jog.posture(self._state.joints + step).sigma, self._jog.onset
        risen = np.minimum(ahead, onset) - np.minimum(self.posture.sigma, onset)
        return float(risen.sum())

    def _sliding(self, place: str, is_leaving: bool = False) -> _Drive:
        stops = self._jog.scaling.stops(self._state.joints, AT_STOP)
        damping = 0.5 * self._jog.onset
        rates = sliding_rates(self.posture.jacobian, self._twist, damping, *stops)
        rates = without_noise(rates)
        scale = self._scale(rates, STRAIGHT)
        return _Drive(rates, scale.part, SLIDING + place, True, is_leaving)

    def _is_trapped(self) -> bool:
        """Whether none of the twelve unit twists can be driven."""
        near_stops = self._jog.scaling.stops(self._state.joints, CORNER)
        unit_rates = self.posture.damped_rates(np.eye(6), self._jog._onset).T
        free = np.flatnonzero(~blocked(unit_rates, *near_stops))
        if self._jog.slides or self.sigma_min >= self._jog.onset or free.size in (0, 12):
            return free.size == 0
        size = float(np.sqrt(self._twist @ self._twist))
        units = size * np.concatenate([np.eye(6), -np.eye(6)])[free]
        drives = [self._scaled(self._exact(unit)) for unit in units]
        return all(drive.scale == 0.0 or _presses(drive.rates, *near_stops) for drive in drives)


def _presses(rates: Array, at_low: Mask, at_high: Mask) -> bool:
    """Whether one of the joints (6,) turns to the end of its range at which it stands."""
    return bool((rates[at_low] < 0.0).any() or (rates[at_high] > 0.0).any())
