"""What viewers show of a machine: the frames of its moving parts, and lines through its joints."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

PLATFORM = 'platform'


@dataclass(frozen=True, eq=False)
class Link:
    """A moving part and T_base_link; the machine's last link is the platform, or the tool."""

    name: str
    pose: Pose


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line through points (n, 3), base frame, metres.

    part is what it is of: body, crank, rod, platform or link. owners (n), where there are any,
    are whose limits each point shows: see `Limit`.
    """

    part: str
    points: Array
    owners: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Freezes the points."""
        object.__setattr__(self, 'points', frozen(self.points))


def outline(part: str, points: Array) -> Stroke:
    """A closed line through the points in the order in which they are given."""
    return Stroke(part, np.vstack([points, points[:1]]))
