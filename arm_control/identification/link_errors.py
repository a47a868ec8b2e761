"""What a link may be otherwise than its file says: where it carries the next joint's axis.

A line has four freedoms beside another one. The first is the joint's zero angle; the other three
are, as in the tables of Denavit and Hartenberg, a shift along the joint's axis (offset), a shift
along the common normal to the next axis (length) and a turn about that normal (twist). Beside a
parallel axis the offset changes nothing and another turn takes its place, about the third
direction (skew; Hayati, IEEE CDC 1983).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from arm_control.subproblems import perpendicular
from manipulator.arrays import Array
from manipulator.pose import Pose

PARALLEL = 1e-3
"""Sine of the angle of two axes below which an offset is no longer told from the next one."""

COAXIAL = 1e-3
"""Metres between parallel axes below which their common normal may point anywhere."""


@dataclass(frozen=True, eq=False)
class LinkError:
    """One freedom of a link, in base axes at zero angles: along or about a line, what is beyond.

    kind is offset, length, twist or skew; direction a unit vector (3,), point (3,) in metres.
    """

    link: int
    kind: str
    direction: Array
    point: Array

    @property
    def is_turn(self) -> bool:
        """Whether its value is in radians, not in metres."""
        return self.kind in ('twist', 'skew')

    def displacement(self, value: float) -> Pose:
        """What it does to all that comes behind the link."""
        if not self.is_turn:
            return Pose(value * self.direction, np.eye(3))
        turn = Pose.identity().moved(np.concatenate([np.zeros(3), value * self.direction]))
        return Pose(self.point - turn.rotation @ self.point, turn.rotation)

    def twist(self, moved: Pose, tool: Array) -> Array:
        """The tool's twist (n, 6) by its unit, with the line moved (n,) and the tool at (n, 3)."""
        direction = moved.rotation @ self.direction
        if not self.is_turn:
            return np.concatenate([direction, np.zeros_like(direction)], axis=-1)
        arm = tool - (moved.rotation @ self.point + moved.position)
        return np.concatenate([np.cross(direction, arm), direction], axis=-1)


def link_errors(chain: Chain) -> tuple[LinkError, ...]:
    """Three of each link between two joints, from the base on."""
    return tuple(error for i in range(len(chain.axes) - 1) for error in _of_link(chain, i))


def _of_link(chain: Chain, i: int) -> Iterator[LinkError]:
    axis, following = chain.axes[i], chain.axes[i + 1]
    point = chain.points[i + 1]
    across = np.cross(axis, following)
    sine = float(np.linalg.norm(across))
    if sine > PARALLEL:
        normal = across / sine
        yield LinkError(i + 1, 'offset', axis, point)
        yield LinkError(i + 1, 'length', normal, point)
        yield LinkError(i + 1, 'twist', normal, point)
        return
    arm = point - chain.points[i]
    arm = arm - (arm @ axis) * axis
    length = float(np.linalg.norm(arm))
    normal = arm / length if length > COAXIAL else perpendicular(axis)
    yield LinkError(i + 1, 'length', normal, point)
    yield LinkError(i + 1, 'twist', normal, point)
    yield LinkError(i + 1, 'skew', np.cross(axis, normal), point)
