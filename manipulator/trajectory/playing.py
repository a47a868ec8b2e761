"""A plan under way."""

from dataclasses import dataclass

from manipulator.trajectory.path_timing import TimedPath
from manipulator.trajectory.plan import Hold, MotionState, Plan
from manipulator.trajectory.plan_modes import MODES


@dataclass
class Playing:
    """A plan, the stamp of the goal that it came from, and how far its own time has come."""

    plan: Plan
    stamp: float = 0.0
    time: float = 0.0

    @property
    def state(self) -> MotionState:
        """Where the plan is now, in its own time."""
        return self.plan.at(self.time)

    @property
    def end(self) -> MotionState:
        """Where it ends."""
        return self.plan.at(self.plan.duration)

    @property
    def mode(self) -> str:
        """What people call it."""
        return MODES[type(self.plan)]

    @property
    def is_hold(self) -> bool:
        """Whether it is to stand still."""
        return isinstance(self.plan, Hold)

    @property
    def is_over(self) -> bool:
        """Whether its end has been reached; standing still has none."""
        return self.time >= self.plan.duration and not self.is_hold

    @property
    def percent(self) -> int | None:
        """How much of a path's time is over; None for other plans."""
        return self.plan.percent(self.time) if isinstance(self.plan, TimedPath) else None
