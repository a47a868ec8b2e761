"""What to draw of a machine: lines through its joints, for markers, pages and figures."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line through points (n, 3), base frame, metres.

    part is what it is of: body, crank, rod, platform or link.
    """

    part: str
    points: Array

    def __post_init__(self) -> None:
        """Freezes the points."""
        object.__setattr__(self, 'points', frozen(self.points))


def outline(part: str, points: Array) -> Stroke:
    """A closed line through the points in the order in which they are given."""
    return Stroke(part, np.vstack([points, points[:1]]))
