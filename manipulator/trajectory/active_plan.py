"""A plan that is executed, and the time scaling that advances it.

At a scaling factor of 1 the plan's own time runs as planned, at 0 it is halted.
"""

from dataclasses import dataclass, replace
from functools import cached_property

from manipulator.errors import Refused
from manipulator.planning.cycle import Cycle
from manipulator.planning.joint_move import JointMove
from manipulator.planning.joint_stream import JointMoveInMotion
from manipulator.planning.joint_trajectory import JointTrajectory
from manipulator.planning.path_timing import TimedPath
from manipulator.planning.plan import Hold, MotionState, Plan
from manipulator.planning.point_to_point import LineMove, MoveInMotion
from manipulator.states import MotionMode

MODES: dict[type, MotionMode] = {
    Hold: MotionMode.HOLD,
    LineMove: MotionMode.MOVE,
    MoveInMotion: MotionMode.MOVE,
    JointMove: MotionMode.MOVE,
    JointMoveInMotion: MotionMode.MOVE,
    Cycle: MotionMode.CYCLE,
    TimedPath: MotionMode.PATH,
    JointTrajectory: MotionMode.PATH,
}


TIMED = TimedPath, JointTrajectory


@dataclass(frozen=True, eq=False)
class ActivePlan:
    """A plan, stamp and note of the goal that it came from, and how far its own time has come."""

    plan: Plan
    stamp: float = 0.0
    note: str = ''
    time: float = 0.0

    def at_time(self, time: float) -> 'ActivePlan':
        """The same plan at another of its times."""
        return replace(self, time=time)

    @cached_property
    def state(self) -> MotionState:
        """The state at the present time."""
        return self.plan.at(self.time)

    @property
    def end(self) -> MotionState:
        """The state at the end."""
        return self.plan.at(self.plan.duration)

    @property
    def mode(self) -> MotionMode:
        """The motion mode of `motion_status`."""
        return MODES[type(self.plan)]

    @property
    def is_hold(self) -> bool:
        """Whether it is a hold plan."""
        return isinstance(self.plan, Hold)

    @property
    def is_over(self) -> bool:
        """Whether its end has been reached; a hold plan has none."""
        return self.time >= self.plan.duration and not self.is_hold

    @property
    def percent(self) -> int | None:
        """How much of the time of a path or trajectory is over; None for other plans."""
        plan = self.plan
        return plan.percent(self.time) if isinstance(plan, TIMED) else None


SPEEDING_UP_RATE = 2.0
"""Change of the factor per second when a cycle begins, a pause ends or the override is raised."""


class TimeScaling:
    """The scaling factor, its target, and its bounded rate of change.

    is_paused: by the user. is_blind: the joints' positions are unknown. is_stopping: the active
    plan is braked, and dropped at rest. most: what the machine's accuracy allows at the moment.
    """

    def __init__(self, braking_rate: float, dt: float) -> None:
        """braking_rate: most change of the factor (1/s), see `MotionLimits.braking_rate`."""
        self.factor = 1.0
        self.is_paused = self.is_blind = self.is_stopping = False
        self.most = 1.0
        self._override = 1.0
        self._fall = braking_rate * dt
        self._rise = min(SPEEDING_UP_RATE * dt, self._fall)

    @property
    def target(self) -> float:
        """The factor to approach."""
        is_held = self.is_paused or self.is_blind or self.is_stopping
        return 0.0 if is_held else min(self._override, self.most)

    def override(self, rate: float) -> None:
        """Runs everything at `rate` times its speed; Refused outside [0, 1]."""
        if not 0.0 <= rate <= 1.0:
            raise Refused(f'speed override {rate:g} outside [0, 1]')
        self._override = rate

    def jump(self) -> None:
        """Sets the factor to its target at once: allowed while nothing moves."""
        self.factor = self.target

    def advance(self) -> None:
        """One tick towards the target."""
        self.factor = min(self.factor + self._rise, max(self.factor - self._fall, self.target))
