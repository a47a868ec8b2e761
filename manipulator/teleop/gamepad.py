"""The mapping file of one kind of gamepad: what its axes and buttons mean."""

import dataclasses
import difflib
from collections import Counter
from dataclasses import dataclass
from typing import Literal

from manipulator.config import quantity
from manipulator.errors import ConfigError
from manipulator.teleop.modes import MODES
from manipulator.teleop.press import Press
from manipulator.teleop.stick import Stick
from manipulator.words import shown

CommandFrame = Literal['base', 'work', 'pivot', 'tool']
"""The frames that a twist may be told in."""


@dataclass(frozen=True)
class Gamepad:
    """A mapping; docs/joystick.md says what each control does. Times in seconds.

    lost_after: without a message for so long the deadman is off until it is pressed anew.
    still_after: while driving, without a change of any number for so long the deadman is off
    until a number changes. repress_after: after so long without a change, until pressed anew.
    """

    description: str
    deadman: Press
    sticks: tuple[Stick, ...]
    shift: Press | None = None
    turbo: Press | None = None
    slow: Press | None = None
    mode_next: Press | None = None
    mode_previous: Press | None = None
    frame_next: Press | None = None
    gripper_open: Press | None = None
    gripper_close: Press | None = None
    home: Press | None = None
    stop: Press | None = None
    turbo_factor: float = quantity(1.0, 10.0, default=2.0)
    slow_factor: float = quantity(0.01, 1.0, default=0.2)
    modes: tuple[str, ...] = ('free',)
    frames: tuple[CommandFrame, ...] = ('base',)
    lost_after: float = quantity(0.02, 0.2, default=0.2)
    still_after: float = quantity(0.05, 60.0, default=0.2)
    repress_after: float = quantity(0.05, 60.0, default=3.0)

    def __post_init__(self) -> None:
        """Raises ConfigError for unknown modes, empty lists and controls that collide."""
        problems = [
            f'{name}: empty' for name in ('sticks', 'modes', 'frames') if not getattr(self, name)
        ]
        for mode in self.modes:
            if mode not in MODES:
                near = difflib.get_close_matches(mode, MODES, n=1)
                hint = f', did you mean {near[0]!r}?' if near else ''
                problems.append(f'modes: {shown(mode)} is not one of {list(MODES)}{hint}')
        if self.shift is None and any(stick.layer == 'shift' for stick in self.sticks):
            problems.append('shift: missing, but a stick has the layer shift')
        taken = Counter((p.button, p.axis, p.beyond > p.rest) for p in self.presses.values())
        for (button, axis, _), count in taken.items():
            if count > 1:
                where = f'axis {axis}' if button is None else f'button {button}'
                problems.append(f'{where}: has {count} meanings')
        if problems:
            raise ConfigError(problems)

    @property
    def presses(self) -> dict[str, Press]:
        """Every button or axis that is pressed, by the name of what it does."""
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        return {name: value for name, value in values.items() if isinstance(value, Press)}
