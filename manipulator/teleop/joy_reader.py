"""From a gamepad's messages to its user's command, failing closed.

A value without a clock: `receive` takes a message with its receipt time and returns the
successor, `command` returns what holds at a later time. Four rules keep it safe:

- *Trust.* A control counts only after it was seen at rest. So a trigger that reports 0 before
  its first touch moves nothing, nor does a deadman that is stuck, or held while the pad comes
  back; nor does a driver's leftover state.
- *Silence.* Without messages for `lost_after` everything is released and all trust is gone.
- *Stillness.* A thumb trembles, a frozen pad does not. While driving, a stream in which no number
  changes for `still_after` counts as frozen; the first change goes on, unless it comes later
  than `repress_after`.
- *One pad.* While two publishers send at once, everything is released and all trust is gone.

What a Joy message must hold before anything in it is believed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.formatting import counted
from manipulator.teleop.gamepad import COMPONENTS, Gamepad

BEYOND_FULL = 1.05
"""Drivers that scale by an odd maximum exceed 1 a little."""

MAX_NUMBERS = 64


def check_numbers(gamepad: Gamepad, axes: Sequence[float], buttons: Sequence[int]) -> None:
    """Raises InvalidInput naming the index that is missing, not finite or out of range.

    One bad number makes the whole message bad, also where nothing is mapped to it: a driver that
    sends it cannot be believed in the rest.
    """
    if len(axes) > MAX_NUMBERS or len(buttons) > MAX_NUMBERS:
        raise InvalidInput(
            f'{counted(len(axes), "axis", "axes")} and {counted(len(buttons), "button")}, '
            f'at most {MAX_NUMBERS} of each'
        )
    for i, value in enumerate(axes):
        if not abs(value) <= BEYOND_FULL:
            raise InvalidInput(f'axis {i} is {value:g}, outside [-{BEYOND_FULL}, {BEYOND_FULL}]')
    for i, state in enumerate(buttons):
        if state not in (0, 1):
            raise InvalidInput(f'button {i} is {state}, needs 0 or 1')
    used: list[tuple[str, int, str]] = [
        ('axis', stick.axis, stick.moves) for stick in gamepad.sticks
    ]
    for name, press in gamepad.presses.items():
        used += [('axis', press.axis, name)] if press.axis is not None else []
        used += [('button', press.button, name)] if press.button is not None else []
    counts = {'axis': len(axes), 'button': len(buttons)}
    for kind, index, meaning in used:
        if index >= counts[kind]:
            raise InvalidInput(f'{kind} {index} ({meaning}) is missing: there are {counts[kind]}')


NEVER = float('-inf')
AT_REST = frozen(np.zeros(6))
ONLY_STOP = frozenset({'stop'})


@dataclass(frozen=True, eq=False)
class PadCommand:
    """The user's command at one time.

    twist (6,) in m/s and rad/s, in `frame`, zero unless `is_held`; `grip` is +1 to open, −1 to
    close, 0 to rest. `stops` and `saves` count presses of those buttons. `reason`: why the deadman
    does not count although it may be pressed.
    """

    twist: Array
    frame: str
    mode: str
    is_held: bool
    is_homing: bool
    grip: int
    stops: int
    saves: int
    reason: str


@dataclass(frozen=True, eq=False)
class JoyReader:
    """The state of one gamepad; times are receipt times of a monotonic clock, in seconds."""

    gamepad: Gamepad
    numbers: tuple[float, ...] = ()
    received_at: float = NEVER
    changed: float = NEVER
    trusted: frozenset[str] = frozenset()
    pressed: frozenset[str] = frozenset()
    twist: Array = field(default_factory=lambda: AT_REST)
    mode: int = 0
    frame: int = 0
    stops: int = 0
    saves: int = 0
    fault: str = ''

    def receive(
        self, axes: Sequence[float], buttons: Sequence[int], now: float, crowd: str = ''
    ) -> 'JoyReader':
        """After a message; a bad one counts as all released, and `fault` is the reason.

        crowd: why messages at present are not those of one pad. Of such only the stop button
        counts, and everything else must be seen at rest again afterwards.
        """
        credible = ONLY_STOP if crowd else frozenset(self._controls)
        trusted = self._trust_left(now) & credible
        try:
            check_numbers(self.gamepad, axes, buttons)
        except InvalidInput as error:
            return self._after_bad(str(error), trusted, now)
        numbers = (*axes, *buttons)
        trusted |= self._at_rest(axes, buttons) & credible
        pressed = self._presses(axes, buttons, trusted)
        if pressed & {'stop', 'home'}:
            trusted, pressed = trusted - {'deadman'}, pressed - {'deadman'}
        return replace(
            self,
            numbers=numbers,
            received_at=now,
            changed=now if numbers != self.numbers else self.changed,
            trusted=trusted,
            pressed=pressed,
            twist=self._twist(axes, trusted, pressed),
            fault=crowd,
        )._after_presses(pressed - self.pressed)

    def _after_bad(self, fault: str, trusted: frozenset[str], now: float) -> 'JoyReader':
        held_through = self.pressed - {'deadman'}
        return replace(
            self,
            received_at=now,
            trusted=trusted - held_through,
            pressed=frozenset(),
            twist=AT_REST,
            fault=fault,
        )

    def command(self, now: float) -> PadCommand:
        """What holds at `now`, which is not before the last message."""
        reason = self._why_not(now)
        pressed = frozenset[str]() if reason else self.pressed
        is_held = 'deadman' in pressed
        grip = ('gripper_open' in pressed) - ('gripper_close' in pressed)
        return PadCommand(
            self.twist if is_held else AT_REST,
            self.gamepad.frames[self.frame],
            self.gamepad.modes[self.mode],
            is_held,
            'home' in pressed,
            grip if is_held else 0,
            self.stops,
            self.saves,
            reason,
        )

    @property
    def untrusted(self) -> tuple[str, ...]:
        """The controls that were not seen at rest yet."""
        return tuple(name for name in self._controls if name not in self.trusted)

    @property
    def _controls(self) -> tuple[str, ...]:
        return (*self.gamepad.presses, *(stick.name for stick in self.gamepad.sticks))

    def _why_not(self, now: float) -> str:
        silence, stillness = now - self.received_at, now - self.changed
        if self.received_at == NEVER:
            return 'no message yet'
        if silence > self.gamepad.lost_after:
            return f'no message for {silence:.2f} s'
        if self.twist.any() and stillness > self.gamepad.still_after:
            return f'frozen: no number has changed for {stillness:.2f} s'
        return self.fault

    def _trust_left(self, now: float) -> frozenset[str]:
        """What is still trusted when a message comes at `now`."""
        if now - self.received_at > self.gamepad.lost_after:
            return frozenset()
        if self.twist.any() and now - self.changed > self.gamepad.repress_after:
            return self.trusted - {'deadman'}
        return self.trusted

    def _at_rest(self, axes: Sequence[float], buttons: Sequence[int]) -> frozenset[str]:
        presses = self.gamepad.presses.items()
        names = [name for name, press in presses if press.is_at_rest(axes, buttons)]
        names += [s.name for s in self.gamepad.sticks if s.is_at_rest(axes[s.axis])]
        return frozenset(names)

    def _presses(
        self, axes: Sequence[float], buttons: Sequence[int], trusted: frozenset[str]
    ) -> frozenset[str]:
        presses = self.gamepad.presses.items()
        return frozenset(n for n, p in presses if n in trusted and p.is_pressed(axes, buttons))

    def _twist(
        self, axes: Sequence[float], trusted: frozenset[str], pressed: frozenset[str]
    ) -> Array:
        if 'deadman' not in pressed:
            return AT_REST
        layers = ('always', 'shift' if 'shift' in pressed else 'plain')
        twist = np.zeros(6)
        for stick in self.gamepad.sticks:
            if stick.layer in layers and stick.name in trusted:
                twist[COMPONENTS.index(stick.moves)] += stick.speed(axes[stick.axis])
        if 'slow' in pressed:
            twist *= self.gamepad.slow_factor
        elif 'turbo' in pressed:
            twist *= self.gamepad.turbo_factor
        return frozen(twist)

    def _after_presses(self, news: frozenset[str]) -> 'JoyReader':
        """Modes and frames change, and poses are saved, only while nothing is driven."""
        stops = self.stops + ('stop' in news)
        if self.twist.any():
            return replace(self, stops=stops)
        saves = self.saves + ('save_pose' in news)
        mode = self.mode + ('mode_next' in news) - ('mode_previous' in news)
        frame = self.frame + ('frame_next' in news)
        return replace(
            self,
            stops=stops,
            saves=saves,
            mode=mode % len(self.gamepad.modes),
            frame=frame % len(self.gamepad.frames),
        )
