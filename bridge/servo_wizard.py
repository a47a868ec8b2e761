"""The servo wizard, from keys to pulses: sign, centre, scale and range of one servo at a time.

A state machine without terminal, port or clock. Only the active servo moves, slowly, never
further than one step at a time and never beyond the pulse range of the machine file.
"""

import enum
import math
from dataclasses import dataclass, replace

from bridge.calibration import COUNTS_PER_US
from bridge.servo_config import ServoConfig
from manipulator.errors import ConfigError
from manipulator.formatting import shown


class Stage(enum.Enum):
    """The question to the user."""

    DIRECTION = 'direction'
    CENTRE = 'centre'
    SCALE = 'scale'
    RANGE = 'range'
    RETURN = 'return'
    REVIEW = 'review'
    WRITE = 'write'
    LEAVE = 'leave'


AFTER = {
    Stage.DIRECTION: Stage.CENTRE,
    Stage.CENTRE: Stage.SCALE,
    Stage.SCALE: Stage.RANGE,
    Stage.RANGE: Stage.RETURN,
}


SPEED_US_S = 150.0
"""A quarter of a turn takes 6 s with an SG90."""

STEPS_US = (0.5, 2.0, 5.0, 20.0, 50.0)
LEAST_JOG_US = 20.0
LEAST_SPAN_US = 100.0
"""Between two angles that a scale is taken from: a pointer is read to a degree or so."""

MOST_SCALE_CHANGE = 2.0
LONGER, SHORTER = ('right', 'up', 'd'), ('left', 'down', 'a')
NUMBER = '0123456789.-'


@dataclass(frozen=True)
class ServoWizard:
    """The values found so far; pulses in microseconds, in the order of `servos`.

    limits are the pulse ranges as they were before; chosen the servos to calibrate, `at` the
    active one of them. `typed` is a number being typed, None where none is; `notice` the answer to
    the last key.
    """

    servos: tuple[ServoConfig, ...]
    limits: tuple[tuple[float, float], ...]
    pulses: tuple[float, ...]
    chosen: tuple[int, ...]
    target: float
    at: int = 0
    stage: Stage = Stage.DIRECTION
    begun_at: float = 0.0
    step: float = 20.0
    typed: str | None = None
    notice: str = ''

    @classmethod
    def begin(
        cls,
        servos: tuple[ServoConfig, ...],
        pulses: tuple[float, ...],
        chosen: tuple[int, ...],
    ) -> 'ServoWizard':
        """At the first of the chosen servos, with all of them at `pulses`."""
        start = pulses[chosen[0]]
        limits = tuple(servo.pulse_range_us for servo in servos)
        return cls(servos, limits, pulses, chosen, start, begun_at=start)

    @property
    def index(self) -> int:
        """The index of the active servo."""
        return self.chosen[self.at]

    @property
    def servo(self) -> ServoConfig:
        """The active servo, with the values found so far."""
        return self.servos[self.index]

    @property
    def pulse(self) -> float:
        """The present pulse of the active servo."""
        return self.pulses[self.index]

    @property
    def counts(self) -> tuple[int, ...]:
        """What goes on the wire, in the order of the board's channels."""
        on_wire = [0] * len(self.pulses)
        for servo, pulse in zip(self.servos, self.pulses, strict=True):
            on_wire[servo.channel] = round(COUNTS_PER_US * pulse)
        return tuple(on_wire)

    @property
    def is_over(self) -> bool:
        """Whether the wizard has ended."""
        return self.stage in (Stage.WRITE, Stage.LEAVE)

    def stopped_at(self, pulses: tuple[float, ...]) -> 'ServoWizard':
        """After the board has stopped at `pulses`, which become the target."""
        return replace(self, pulses=pulses, target=pulses[self.index])

    def advance(self, dt: float) -> 'ServoWizard':
        """`dt` seconds later; a servo that has returned to its centre hands over to the next."""
        distance = self.target - self.pulse
        reach = SPEED_US_S * dt
        moved = (
            self.target if abs(distance) <= reach else self.pulse + math.copysign(reach, distance)
        )
        pulses = list(self.pulses)
        pulses[self.index] = moved
        there = replace(self, pulses=tuple(pulses))
        is_back = there.stage is Stage.RETURN and there.pulse == there.target
        return there._next_servo() if is_back else there

    def press(self, key: str) -> 'ServoWizard':
        """After one key."""
        if self.typed is not None:
            return self._type(key)
        fresh = replace(self, notice='')
        if self.stage is Stage.REVIEW:
            chosen = {'w': Stage.WRITE, 'q': Stage.LEAVE}.get(key)
            return replace(fresh, stage=chosen) if chosen else fresh._notify('w writes, q leaves')
        if key == 'q':
            return replace(fresh, stage=Stage.REVIEW, target=self.pulse)
        if self.stage is Stage.RETURN:
            return fresh
        if key in LONGER or key in SHORTER:
            return fresh._jog(1.0 if key in LONGER else -1.0)
        if key in ('+', '-'):
            return fresh._resize(1 if key == '+' else -1)
        if key == 's':
            return fresh._go_on()
        if key == 'b':
            return replace(fresh, stage=Stage.DIRECTION, target=self.pulse, begun_at=self.pulse)
        return fresh._answer(key)

    def _answer(self, key: str) -> 'ServoWizard':
        """A key that means something in one stage alone."""
        if self.pulse != self.target:
            return self._notify('it is still moving')
        if self.stage is Stage.DIRECTION and key in ('y', 'n'):
            return self._settle_sign(1 if key == 'y' else -1)
        if self.stage in (Stage.CENTRE, Stage.SCALE) and key == '=':
            return replace(self, typed='')
        if self.stage is Stage.CENTRE and key == 'enter':
            return self._settle_centre(self.servo.centre)
        if self.stage is Stage.RANGE and key in ('[', ']'):
            return self._settle_end(key)
        if self.stage is Stage.RANGE and key == 'enter':
            return self._go_on()
        return self._notify(f'{key!r} has no function here')

    def _jog(self, direction: float) -> 'ServoWizard':
        low, high = self.limits[self.index]
        aim = self.pulse + direction * self.step
        target = min(max(aim, low), high)
        at_end = self._notify('the end of its pulse range') if target != aim else self
        return replace(at_end, target=target)

    def _resize(self, by: int) -> 'ServoWizard':
        index = min(max(STEPS_US.index(self.step) + by, 0), len(STEPS_US) - 1)
        return replace(self, step=STEPS_US[index])

    def _type(self, key: str) -> 'ServoWizard':
        typed = self.typed or ''
        if key == 'enter':
            return replace(self, typed=None)._take_number(typed)
        if key == 'escape':
            return replace(self, typed=None, notice='')
        if key == 'backspace':
            return replace(self, typed=typed[:-1])
        return replace(self, typed=typed + key) if key in NUMBER and len(typed) < 12 else self

    def _take_number(self, typed: str) -> 'ServoWizard':
        try:
            number = float(typed)
        except ValueError:
            return self._notify(f'{shown(typed)} is not a number')
        if self.stage is Stage.CENTRE:
            return self._settle_centre(number)
        return self._settle_scale(number)

    def _settle_sign(self, sign: int) -> 'ServoWizard':
        if abs(self.pulse - self.begun_at) < LEAST_JOG_US:
            return self._notify(f'jog it by {LEAST_JOG_US:g} µs first, and watch it')
        return self._with(sign=sign)._go_on()

    def _settle_centre(self, position: float) -> 'ServoWizard':
        name = 'centre_mm' if self.servo.is_linear else 'centre_deg'
        return self._with(centre_us=_on_wire(self.pulse), **{name: position})._go_on()

    def _settle_scale(self, position: float) -> 'ServoWizard':
        servo, unit = self.servo, 'mm' if self.servo.is_linear else 'deg'
        pulses = self.pulse - servo.centre_us
        change = servo.sign * (position - servo.centre)
        if abs(pulses) < LEAST_SPAN_US:
            return self._notify(f'too near the centre: go {LEAST_SPAN_US:g} µs away from it')
        if change * pulses <= 0.0:
            return self._notify('that contradicts the direction: b begins this servo again')
        scale, present = pulses / change, servo.us_per_mm or servo.us_per_deg or 1.0
        if not present / MOST_SCALE_CHANGE <= scale <= present * MOST_SCALE_CHANGE:
            return self._notify(f'{scale:.3g} µs per {unit} instead of {present:g}: read it again')
        return self._with(**{f'us_per_{unit}': round(scale, 4)})._go_on()

    def _settle_end(self, key: str) -> 'ServoWizard':
        low, high = self.servo.pulse_range_us
        pulse = _on_wire(self.pulse)
        ends = (pulse, high) if key == '[' else (low, pulse)
        changed = self._with(pulse_range_us=ends)
        which = 'shortest' if key == '[' else 'longest'
        return changed if changed.notice else changed._notify(f'{which} pulse {pulse:g} µs')

    def _with(self, **values: object) -> 'ServoWizard':
        """With new values of the active servo, unless they contradict each other."""
        try:
            changed = replace(self.servo, **values)  # type: ignore[arg-type]
        except ConfigError as error:
            return self._notify(str(error))
        servos = list(self.servos)
        servos[self.index] = changed
        return replace(self, servos=tuple(servos), notice='')

    def _go_on(self) -> 'ServoWizard':
        """To the next stage, unless something was wrong with the last answer."""
        if self.notice:
            return self
        stage = AFTER[self.stage]
        target = self.servo.centre_us if stage is Stage.RETURN else self.pulse
        return replace(self, stage=stage, target=target)

    def _next_servo(self) -> 'ServoWizard':
        if self.at + 1 == len(self.chosen):
            return replace(self, stage=Stage.REVIEW)
        start = self.pulses[self.chosen[self.at + 1]]
        ahead = replace(self, at=self.at + 1, stage=Stage.DIRECTION)
        return replace(ahead, target=start, begun_at=start)

    def _notify(self, notice: str) -> 'ServoWizard':
        return replace(self, notice=notice)


def _on_wire(pulse: float) -> float:
    """The nearest pulse that the wire can carry."""
    return round(COUNTS_PER_US * pulse) / COUNTS_PER_US
