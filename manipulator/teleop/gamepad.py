"""The mapping file of one kind of gamepad: what its axes and buttons mean.

An axis that moves the machine has a deadzone, an exponential curve and a speed. A press is that of
a button, or of an axis that is moved far enough from its rest.
"""

import dataclasses
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from manipulator.config import quantity
from manipulator.errors import ConfigError
from manipulator.formatting import not_one_of
from manipulator.teleop.modes import MODES

AT_REST = 0.2
"""How far from its rest an axis may be and still count as untouched."""


@dataclass(frozen=True)
class Press:
    """Either `button`, or `axis` moved from `rest` to `beyond` or further.

    Triggers of most drivers rest at +1 and end at −1; a cross of direction buttons is a pair of
    axes that rest at 0.
    """

    button: int | None = quantity(0, 63, default=None)
    axis: int | None = quantity(0, 63, default=None)
    rest: float = quantity(-1.0, 1.0, default=0.0)
    beyond: float = quantity(-1.0, 1.0, default=0.5)

    def __post_init__(self) -> None:
        """Raises ConfigError for both or neither, and for an axis pressed while at rest."""
        if (self.button is None) == (self.axis is None):
            raise ConfigError(['needs either button or axis'])
        if self.axis is not None and abs(self.beyond - self.rest) <= AT_REST:
            raise ConfigError(
                [f'beyond: {self.beyond:g} is within {AT_REST:g} of the rest, {self.rest:g}']
            )

    def is_pressed(self, axes: Sequence[float], buttons: Sequence[int]) -> bool:
        """Whether it is pressed in a message that has the index."""
        if self.axis is None:
            return buttons[self.button or 0] == 1
        value = axes[self.axis]
        return value >= self.beyond if self.beyond > self.rest else value <= self.beyond

    def is_at_rest(self, axes: Sequence[float], buttons: Sequence[int]) -> bool:
        """Whether it is surely untouched; a trigger half-way is neither at rest nor pressed."""
        if self.axis is None:
            return not self.is_pressed(axes, buttons)
        return abs(axes[self.axis] - self.rest) <= AT_REST


Component = Literal['x', 'y', 'z', 'roll', 'pitch', 'yaw']
COMPONENTS: tuple[Component, ...] = get_args(Component)
"""The order of a twist: m/s along, then rad/s about x, y, z."""


@dataclass(frozen=True)
class Stick:
    """`axis` moves one component; `full_speed` (m/s or rad/s) is meant for full deflection.

    The distance from `rest` to the farther end is one unit; `sign` is that of increase. Within
    `deadzone` units of the rest nothing moves, beyond it the speed rises from 0. `expo` 0 is
    linear, 1 is cubic. A stick of layer 'shift' counts only while shift is held, one of layer
    'plain' only while it is not.
    """

    moves: Component
    axis: int = quantity(0, 63)
    full_speed: float = quantity(1e-4, 10.0)
    sign: Literal[1, -1] = 1
    rest: float = quantity(-1.0, 1.0, default=0.0)
    deadzone: float = quantity(0.0, 0.9, default=0.1)
    expo: float = quantity(0.0, 1.0, default=0.0)
    layer: Literal['always', 'plain', 'shift'] = 'always'

    def __post_init__(self) -> None:
        """Raises ConfigError for a trigger that has no deadzone to be at rest in."""
        if self.rest and not self.deadzone:
            raise ConfigError(['deadzone: 0 outside (0, 0.9], which a trigger needs'])

    @property
    def name(self) -> str:
        """For people."""
        return f'axis {self.axis} ({self.moves})'

    def deflection(self, value: float) -> float:
        """In [−1, 1], before the deadzone."""
        offset = self.sign * (value - self.rest) / (1.0 + abs(self.rest))
        return min(max(offset, -1.0), 1.0)

    def is_at_rest(self, value: float) -> bool:
        """Whether the axis is within its deadzone."""
        return abs(self.deflection(value)) <= self.deadzone

    def speed(self, value: float) -> float:
        """In m/s or rad/s; 0 at the deadzone's edge, full_speed at the end."""
        offset = self.deflection(value)
        if abs(offset) <= self.deadzone:
            return 0.0
        rescaled = (abs(offset) - self.deadzone) / (1.0 - self.deadzone)
        bent = (1.0 - self.expo) * rescaled + self.expo * rescaled**3
        return math.copysign(self.full_speed * bent, offset)


CommandFrame = Literal['base', 'work', 'pivot', 'tool']
"""The frames in which a twist may be given."""


@dataclass(frozen=True)
class Gamepad:
    """A mapping; docs/joystick.md describes each control. Times in seconds.

    lost_after: without a message for so long the deadman is off until it is pressed again.
    still_after: while driving, without a change of any number for so long the deadman is off
    until a number changes. repress_after: after so long without a change, until pressed again.
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
    save_pose: Press | None = None
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
        problems += [f'modes: {not_one_of(m, MODES)}' for m in self.modes if m not in MODES]
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
