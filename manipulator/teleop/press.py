"""A press on a gamepad: of a button, or of an axis that is moved far enough from its rest."""

from collections.abc import Sequence
from dataclasses import dataclass

from manipulator.config import quantity
from manipulator.errors import ConfigError

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
