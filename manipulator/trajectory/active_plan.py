"""A plan that is executed, and the time scaling that advances it.

At 1 the plan's own time runs as planned, at 0 it stands.
"""

from dataclasses import dataclass

from manipulator.errors import Refused
from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.joint_move import JointMove
from manipulator.trajectory.path_timing import TimedPath
from manipulator.trajectory.plan import Hold, MotionState, Plan
from manipulator.trajectory.point_to_point import Move, StraightMove

MODES: dict[type, str] = {
    Hold: 'hold',
    StraightMove: 'move',
    Move: 'move',
    JointMove: 'move',
    Cycle: 'cycle',
    TimedPath: 'path',
}


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


SPEEDING_UP_RATE = 2.0
"""Change of rate per second when a cycle begins, a pause ends or the override is raised."""


class Pace:
    """The rate, and all that holds it back; it changes no faster than plans leave room for.

    is_paused: the user's own wish. is_blind: nobody knows where the joints are. is_stopping: what
    is driven is braked, to be dropped once it stands.
    """

    def __init__(self, braking_rate: float, dt: float) -> None:
        """braking_rate: the largest change of rate (1/s), see `MotionLimits.braking_rate`."""
        self.rate = 1.0
        self.is_paused = self.is_blind = self.is_stopping = False
        self._override = 1.0
        self._fall = braking_rate * dt
        self._rise = min(SPEEDING_UP_RATE * dt, self._fall)

    @property
    def wanted(self) -> float:
        """Where the rate goes."""
        is_held = self.is_paused or self.is_blind or self.is_stopping
        return 0.0 if is_held else self._override

    def override(self, rate: float) -> None:
        """Runs everything at `rate` times its speed; Refused outside [0, 1]."""
        if not 0.0 <= rate <= 1.0:
            raise Refused(f'speed override {rate:g} outside [0, 1]')
        self._override = rate

    def jump(self) -> None:
        """At once to the rate that is wanted: allowed while nothing moves."""
        self.rate = self.wanted

    def advance(self) -> None:
        """One tick towards the rate that is wanted."""
        self.rate = min(self.rate + self._rise, max(self.rate - self._fall, self.wanted))
