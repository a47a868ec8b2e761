"""Jerk-limited moves from rest to rest: a straight line and a turn about one fixed axis."""

from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.trajectory.plan import MotionState, PosePlan
from manipulator.trajectory.profile import FASTEST, Profile, profile_within


@dataclass(frozen=True, eq=False)
class StraightMove(PosePlan):
    """start.moved(s·way): s goes from 0 to 1 along the profile, way is start.twist_to(goal)."""

    start: Pose
    way: Array
    profile: Profile

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return self.profile.duration

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...)."""
        s, rate, pull = (value[..., None] for value in self.profile.at(times))
        position = self.start.position + s * self.way[:3]
        turn = so3.exp(s * self.way[3:]) @ self.start.rotation
        return MotionState(Pose(position, turn), rate * self.way, pull * self.way)

    def where(self, time: float) -> str:
        """See `Plan`."""
        share, _, _ = self.profile.at(time)
        return f'at {100 * float(share):.0f} % of the line'


def plan_straight(
    start: Pose, goal: Pose, limits: MotionLimits, slowness: float = 1.0
) -> StraightMove:
    """The quickest such move; slowness k ≥ 1 makes it take k times as long."""
    way = start.twist_to(goal)
    lengths = float(np.linalg.norm(way[:3])), float(np.linalg.norm(way[3:]))
    parts = tuple(zip((limits.linear, limits.angular), lengths, strict=True))
    bounds = [
        min(
            getattr(limit, name) / length if length > getattr(limit, name) / FASTEST else FASTEST
            for limit, length in parts
        )
        for name in ('speed', 'acceleration', 'jerk')
    ]
    return StraightMove(start, way, profile_within(bounds, slowness))
