"""The move that follows a stream of poses: to the newest one in motion, then to rest."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.motion_limits import MotionLimits
from manipulator.planning.flowing import Attempt, Quintic, quintic_to
from manipulator.planning.goal import Flow
from manipulator.planning.plan import MotionState, PosePlan
from manipulator.planning.point_to_point import (
    MoveInMotion,
    coordinates,
    plan_move_in_motion,
    state_of,
)
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class StreamMove(PosePlan):
    """`early`, in the local coordinates of the goal, then a move to rest."""

    early: Quintic
    rest: MoveInMotion

    @property
    def duration(self) -> float:
        """Seconds until rest at the goal."""
        return self.early.span + self.rest.duration

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...)."""
        flat, span = np.ravel(times), self.early.span
        early = state_of(*self.early.at(flat), self.rest.goal.rotation)
        late = self.rest.at(np.maximum(flat - span, 0.0))
        is_early = flat < span
        parts = []
        for first, second in (
            (early.pose.position, late.pose.position),
            (early.pose.rotation, late.pose.rotation),
            (early.twist, late.twist),
            (early.acceleration, late.acceleration),
        ):
            chosen = is_early.reshape(-1, *(1,) * (first.ndim - 1))
            both = np.where(chosen, first, second)
            parts.append(both.reshape(*np.shape(times), *first.shape[1:]))
        position, rotation, twist, acceleration = parts
        return MotionState(Pose(position, rotation), twist, acceleration)

    def where(self, time: float) -> str:
        """See `Plan`."""
        return f'at {100 * min(time / self.duration, 1.0):.0f} % of the time to the goal'


def plan_stream_move(
    start: MotionState, goal: Pose, flow: Flow, time: float, limits: MotionLimits, how: Attempt
) -> StreamMove | None:
    """From any state, at that time, to the goal with its flow; to rest if no other comes.

    None where a coordinate would pass its jerk. Raises Refused where there is no move to rest.
    """
    jerks = np.repeat([limits.linear.jerk, limits.angular.jerk], 3)
    target = np.concatenate([goal.position, np.zeros(3)])
    early = quintic_to(coordinates(start, goal.rotation), target, flow, time, jerks, how.later)
    if early is None:
        return None
    state = state_of(*early.end, goal.rotation)
    return StreamMove(early, plan_move_in_motion(state, goal, limits, how.slowdown))
