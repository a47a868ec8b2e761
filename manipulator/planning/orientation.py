"""The orientation of goals and paths that are given as points: kept as the jog modes keep it."""

from dataclasses import dataclass
from enum import Enum
from itertools import pairwise
from math import ceil

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import turn_between
from manipulator.teleop.modes import NEAREST, TOOL_AXIS

MOST_TURN = np.radians(2.0)
"""Between two poses of a path that looks at a point: between them it misses by 0.006° at most."""


MOST_PLACES = 10_000
"""Poses of such a path: 55 turns about the point."""


class Orientation(Enum):
    """Where a goal's orientation comes from; parameter `goal_orientation`, names as `jog_mode`."""

    GIVEN = 'given'
    """The goal itself."""
    HOLD = 'hold_orientation'
    """That of the start."""
    PARALLEL = 'parallel'
    """The start's, with the approach axis turned to the nearest of ±x, ±y, ±z."""
    LOOK_AT = 'look_at'
    """The approach axis points at a point, by the shortest turn at each step."""


@dataclass(frozen=True, eq=False)
class OrientationRule:
    """An orientation, and the point (3,) of LOOK_AT, in the frame of the poses."""

    orientation: Orientation = Orientation.GIVEN
    point: Array | None = None

    @property
    def is_given(self) -> bool:
        """Whether goals have orientations of their own."""
        return self.orientation is Orientation.GIVEN

    def applied(self, goal: Pose, start: Pose) -> Pose:
        """The goal with its orientation; Refused where the point is missing or too near."""
        match self.orientation:
            case Orientation.GIVEN:
                return goal
            case Orientation.HOLD:
                return Pose(goal.position, start.rotation)
            case Orientation.PARALLEL:
                approach = start.rotation @ np.array(TOOL_AXIS)
                nearest = int(np.argmax(np.abs(approach)))
                return _aimed(goal, start, np.eye(3)[nearest] * np.sign(approach[nearest]))
            case Orientation.LOOK_AT:
                return _aimed(goal, start, self._sight(goal.position)[1])

    def along(self, poses: Pose, start: Pose) -> tuple[Pose, Array]:
        """Poses (n,) with their orientations, and the place (m,) of each in the row given.

        A place of 2.5 is midway between the third and the fourth: a path that looks at a point
        needs poses between those given. Refused with the pose's number.
        """
        places = self._places(poses.position)
        whole = np.minimum(places.astype(int), len(poses.position) - 1)
        after = np.minimum(whole + 1, len(poses.position) - 1)
        share = (places - whole)[:, None]
        positions = (1.0 - share) * poses.position[whole] + share * poses.position[after]
        rotations, last = [], start
        for k, position in zip(whole, positions, strict=True):
            last = self.applied(Pose(position, poses.rotation[k]), last)
            rotations.append(last.rotation)
        return Pose(positions, np.array(rotations)), places

    def _places(self, positions: Array) -> Array:
        """Where poses are needed: at those given, and between them at equal turns of the sight."""
        rows = np.arange(float(len(positions)))
        if self.orientation is not Orientation.LOOK_AT:
            return rows
        places = [0.0]
        for k, (begin, end) in enumerate(pairwise(positions)):
            try:
                self._sight(_nearest(begin, end, self.point))
            except Refused as error:
                raise Refused(f'pose {k + 1} and from there: {error}') from error
            places += [k + share for share in self._shares(begin, end)]
            if len(places) > MOST_PLACES:
                raise Refused(
                    f'pose {k + 2}: looking at the point takes more than {MOST_PLACES:,} poses, '
                    f'one for each {np.degrees(MOST_TURN):.0f}° of turn'
                )
        return np.array(places)

    def _shares(self, begin: Array, end: Array) -> list[float]:
        """The shares of a segment at whose ends the sight has turned by MOST_TURN at most."""
        (near, before), (far, after) = self._sight(begin), self._sight(end)
        whole = float(np.linalg.norm(turn_between(before, after)))
        turns = np.linspace(0.0, whole, ceil(whole / MOST_TURN) + 1)[1:-1]
        ahead, behind = near * np.sin(turns), far * np.sin(whole - turns)
        return [*(ahead / (ahead + behind)).tolist(), 1.0]

    def _sight(self, position: Array) -> tuple[float, Array]:
        """Distance and direction (3,) of the point from a position."""
        if self.point is None:
            raise Refused('goal_orientation look_at: no point was given yet (topic look_at)')
        arm = self.point - position
        distance = float(np.linalg.norm(arm))
        if distance < NEAREST:
            raise Refused(
                f'the look-at point is {distance:.4g} m from the tool, needs at least {NEAREST} m'
            )
        return distance, arm / distance


def _aimed(goal: Pose, start: Pose, direction: Array) -> Pose:
    """The goal's position, and the start's rotation with the approach axis along `direction`."""
    turn = turn_between(start.rotation @ np.array(TOOL_AXIS), direction)
    return Pose(goal.position, so3.exp(turn) @ start.rotation)


def _nearest(begin: Array, end: Array, point: Array | None) -> Array:
    """The position (3,) of the segment that is nearest to the point, where there is one."""
    way = end - begin
    length = float(way @ way)
    if point is None or length == 0.0:
        return begin
    result: Array = begin + min(max(float((point - begin) @ way) / length, 0.0), 1.0) * way
    return result
