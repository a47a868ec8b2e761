"""Jerk-limited moves from rest to rest: a straight line and a turn about one fixed axis."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import ruckig

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.trajectory.plan import MotionState

FASTEST = 1e9


@dataclass(frozen=True, eq=False)
class StraightMove:
    """start.moved(s·way): s goes from 0 to 1 by a ruckig profile, way is start.twist_to(goal)."""

    start: Pose
    way: Array
    duration: float
    _profile: Any

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...)."""
        flat = np.clip(np.ravel(times), 0.0, self.duration)
        samples = np.array([self._profile.at_time(t)[:3] for t in flat.tolist()])
        s, rate, change = np.moveaxis(samples.reshape(*np.shape(times), 3, 1), -2, 0)
        position = self.start.position + s * self.way[:3]
        turn = so3.exp(s * self.way[3:]) @ self.start.rotation
        return MotionState(Pose(position, turn), rate * self.way, change * self.way)


def plan_straight(
    start: Pose, goal: Pose, limits: MotionLimits, slowness: float = 1.0
) -> StraightMove:
    """The quickest such move; slowness k ≥ 1 makes it take k times as long."""
    way = start.twist_to(goal)
    lengths = np.linalg.norm(way[:3]), np.linalg.norm(way[3:])
    request = ruckig.InputParameter(1)
    request.target_position = [1.0]
    for name, power in (('speed', 1), ('acceleration', 2), ('jerk', 3)):
        bounds = [
            getattr(limit, name) / length
            for limit, length in zip((limits.linear, limits.angular), lengths, strict=True)
            if length > getattr(limit, name) / FASTEST
        ]
        ruckig_name = 'velocity' if name == 'speed' else name
        setattr(request, f'max_{ruckig_name}', [min(bounds, default=FASTEST) / slowness**power])
    profile = ruckig.Trajectory(1)
    result = ruckig.Ruckig(1).calculate(request, profile)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise Refused(f'no jerk-limited move was found ({result.name})')
    return StraightMove(start, way, float(profile.duration), profile)
