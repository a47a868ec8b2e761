"""The state of a gamepad as the kernel reports it, and the numbers that Joy makes of it.

The order is that of the `joy` package's joy_node on Linux: axes and buttons by rising kernel code
(linux/input-event-codes.h), left and up +1, triggers +1 at rest. A pad that has motion sensors
gets one axis more at the end, its heartbeat: the sensors report all the time, so a heartbeat that
does not change distinguishes a frozen pad from a steady thumb.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from manipulator.errors import InvalidInput

KEY, ABS = 1, 3
"""Kinds of events (EV_KEY, EV_ABS)."""

FIRST_BUTTON, LAST_BUTTON = 0x120, 0x15F
"""From BTN_JOYSTICK to the end of the gamepads' codes."""

GAMEPAD_BUTTON = 0x130
"""BTN_SOUTH, which every gamepad has."""

STICK_AXIS = 0
"""ABS_X, which every gamepad has."""

AXES = range(0x18)
"""From ABS_X to the direction crosses; beyond are touch pads and volume wheels."""

BEATS = 128
"""Reports of the motion sensors until the heartbeat begins again."""


@dataclass(frozen=True)
class Axis:
    """One axis: its value and its range in the kernel's counts."""

    value: int
    low: int
    high: int

    def __post_init__(self) -> None:
        """Raises InvalidInput for a range without extent."""
        if self.low >= self.high:
            raise InvalidInput(f'axis range [{self.low}, {self.high}] is empty')

    @property
    def joy(self) -> float:
        """In [−1, 1], +1 at the low end."""
        part = (self.value - self.low) / (self.high - self.low)
        return min(max(1.0 - 2.0 * part, -1.0), 1.0)


@dataclass(frozen=True)
class Pad:
    """Axes and buttons by kernel code; `beats` is None for a pad without motion sensors."""

    axes: Mapping[int, Axis]
    buttons: Mapping[int, bool]
    beats: int | None = None

    @classmethod
    def from_device(
        cls, axes: Mapping[int, Axis], keys: Mapping[int, bool], has_heartbeat: bool
    ) -> 'Pad':
        """Of all that a device has, what belongs to a gamepad."""
        return cls(
            {code: axes[code] for code in sorted(axes) if code in AXES},
            {code: keys[code] for code in sorted(keys) if FIRST_BUTTON <= code <= LAST_BUTTON},
            0 if has_heartbeat else None,
        )

    def resumed(self, axes: Mapping[int, Axis], keys: Mapping[int, bool]) -> 'Pad':
        """With all values read again, after events were lost."""
        return replace(
            self,
            axes={code: axes[code] for code in self.axes},
            buttons={code: keys[code] for code in self.buttons},
        )

    def after(self, kind: int, code: int, value: int) -> 'Pad':
        """After one event; what is no gamepad's is ignored."""
        if kind == ABS and code in self.axes:
            return replace(self, axes={**self.axes, code: replace(self.axes[code], value=value)})
        if kind == KEY and code in self.buttons:
            return replace(self, buttons={**self.buttons, code: value != 0})
        return self

    def beaten(self) -> 'Pad':
        """After one report of the motion sensors."""
        return self if self.beats is None else replace(self, beats=(self.beats + 1) % BEATS)

    @property
    def joy(self) -> tuple[list[float], list[int]]:
        """Axes and buttons of a Joy message."""
        axes = [axis.joy for axis in self.axes.values()]
        if self.beats is not None:
            axes.append(self.beats / BEATS)
        return axes, [int(is_down) for is_down in self.buttons.values()]


def is_gamepad(axes: Mapping[int, Axis], keys: Mapping[int, bool]) -> bool:
    """Whether a device with these axes and keys is one (and no mouse, keyboard or sensor)."""
    return STICK_AXIS in axes and GAMEPAD_BUTTON in keys
