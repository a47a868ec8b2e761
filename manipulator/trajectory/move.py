"""Jerk-limited moves from any state of motion to a pose at rest, by ruckig.

The six coordinates are those of `chart` about R_goal: the goal lies at w = 0, far from the
chart's edge at |w| = π.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import ruckig

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.trajectory.chart import coordinates, state_of
from manipulator.trajectory.plan import MotionState, PosePlan


@dataclass(frozen=True, eq=False)
class Move(PosePlan):
    """A ruckig trajectory in the coordinates about the goal's orientation."""

    goal: Pose
    duration: float
    _trajectory: Any

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """Position, velocity and acceleration of the coordinates, turned into a state."""
        flat = np.clip(np.ravel(times), 0.0, self.duration)
        samples = np.array([self._trajectory.at_time(t)[:3] for t in flat.tolist()])
        x, v, a = np.moveaxis(samples.reshape(*np.shape(times), 3, 6), -2, 0)
        return state_of(x, v, a, self.goal.rotation)

    def where(self, time: float) -> str:
        """See `Plan`."""
        return f'at {100 * min(time / self.duration, 1.0):.0f} % of the time to the goal'


def plan_move(start: MotionState, goal: Pose, limits: MotionLimits, slowness: float = 1.0) -> Move:
    """The quickest move within the limits on speed, acceleration and jerk of each coordinate.

    slowness k ≥ 1 divides speed by k, acceleration by k² and jerk by k³. Raises Refused where
    ruckig finds none.
    """
    request = ruckig.InputParameter(6)
    x, v, a = coordinates(start, goal.rotation)
    request.current_position, request.current_velocity = x.tolist(), v.tolist()
    request.current_acceleration = a.tolist()
    request.target_position = [*goal.position.tolist(), 0.0, 0.0, 0.0]
    for name, power in (('speed', 1), ('acceleration', 2), ('jerk', 3)):
        bounds = [getattr(limits.linear, name) / slowness**power] * 3
        bounds += [getattr(limits.angular, name) / slowness**power] * 3
        ruckig_name = 'velocity' if name == 'speed' else name
        setattr(request, f'max_{ruckig_name}', bounds)
    trajectory = ruckig.Trajectory(6)
    result = ruckig.Ruckig(6).calculate(request, trajectory)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise Refused(f'no jerk-limited move was found ({result.name})')
    return Move(goal, float(trajectory.duration), trajectory)
