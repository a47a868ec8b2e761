"""One axis of a gamepad that moves the machine: deadzone, expo, speed."""

import math
from dataclasses import dataclass
from typing import Literal, get_args

from manipulator.config import quantity
from manipulator.errors import ConfigError

Component = Literal['x', 'y', 'z', 'roll', 'pitch', 'yaw']
COMPONENTS: tuple[Component, ...] = get_args(Component)
"""The order of a twist: m/s along, then rad/s about x, y, z."""


@dataclass(frozen=True)
class Stick:
    """`axis` moves one component; `full_speed` (m/s or rad/s) is meant for full deflection.

    The way from `rest` to the farther end is one unit; `sign` says which way is positive. Within
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
        way = self.sign * (value - self.rest) / (1.0 + abs(self.rest))
        return min(max(way, -1.0), 1.0)

    def is_at_rest(self, value: float) -> bool:
        """Whether the axis is within its deadzone."""
        return abs(self.deflection(value)) <= self.deadzone

    def speed(self, value: float) -> float:
        """In m/s or rad/s; 0 at the deadzone's edge, full_speed at the end."""
        way = self.deflection(value)
        if abs(way) <= self.deadzone:
            return 0.0
        rescaled = (abs(way) - self.deadzone) / (1.0 - self.deadzone)
        bent = (1.0 - self.expo) * rescaled + self.expo * rescaled**3
        return math.copysign(self.full_speed * bent, way)
