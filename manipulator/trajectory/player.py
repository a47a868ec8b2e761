"""Playing plans tick by tick: goals in, setpoints out, and every stop along the checked way.

A plan runs in its own time, whose rate goes from 0 (paused) to 1 (full speed). Stopping, pausing
and slowing change the rate alone, so the machine never leaves the way that was checked. A jog
begins and ends at rest: it first brakes the plan, and drops it.
"""

from dataclasses import replace

import numpy as np

from manipulator.arrays import Array
from manipulator.continuity import BRANCH_JUMP
from manipulator.errors import Refused, Unreachable
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.goal import Goal
from manipulator.trajectory.jogging import Jogging, Wish
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.path_timing import TimedPath
from manipulator.trajectory.plan import Hold, MotionState, Plan
from manipulator.trajectory.plan_modes import MODES
from manipulator.trajectory.planner import check_cycle, plan_to

SPEEDING_UP_RATE = 2.0
"""Change of rate per second when a cycle begins, a pause ends or the override is raised."""


class Player:
    """Owns the commanded state of one machine from the moment that it is enabled."""

    def __init__(self, machine: Machine, pose: Pose, joints: Array, dt: float) -> None:
        """Begins by holding `pose`, where the joints are."""
        self.status = MotionStatus()
        self.joints = joints
        self._machine = machine
        self._dt = dt
        self._braking_step = machine.motion.braking_rate * dt
        self._plan: Plan = Hold(pose)
        self._time = 0.0
        self._stamp = 0.0
        self._rate = 1.0
        self._override = 1.0
        self.is_paused = False
        self._is_blind = False
        self._is_stopping = False
        self._newest: Goal | None = None
        self._next: Goal | Cycle | TimedPath | None = None
        self.expected: float | None = None
        self._wish: Wish | None = None
        self._jogging: Jogging | None = None
        self._measured: Pose | None = None

    @property
    def state(self) -> MotionState:
        """The commanded state, in the plan's own time while a plan is played."""
        if self._jogging is not None:
            motion = self._jogging.motion
            return MotionState(motion.pose, motion.twist, np.zeros(6))
        return self._plan.at(self._time)

    @property
    def newest_stamp(self) -> float:
        """The stamp of the newest goal, whether it is being driven or still waits."""
        return self._newest.stamp if self._newest is not None else self.status.goal_stamp

    @property
    def pursued(self) -> Pose | None:
        """The newest goal that is driven to or waits; None for other motion and at rest."""
        for waiting in (self._newest, self._next):
            if isinstance(waiting, Goal):
                return waiting.pose
        is_move = MODES[type(self._plan)] == 'move'
        return self._plan.at(self._plan.duration).pose if is_move else None

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves and nothing is about to."""
        is_jogged = self._jogging is not None or self._wish is not None
        return isinstance(self._plan, Hold) and self._newest is None and not is_jogged

    @property
    def is_busy(self) -> bool:
        """Whether a goal or a cycle is being driven, or waits."""
        return not isinstance(self._plan, Hold) or self._newest is not None

    @property
    def _wanted_rate(self) -> float:
        is_held = self.is_paused or self._is_blind or self._is_stopping
        return 0.0 if is_held else self._override

    def pursue(self, goal: Goal) -> None:
        """Takes a goal up at the next tick; of several the newest wins. Refused during a jog."""
        self._refuse_while_jogged()
        self._newest, self.expected = goal, None

    def expect(self, stamp: float) -> None:
        """A path is being worked out; `expected` is its stamp until a newer command comes."""
        self._refuse_while_jogged()
        self.expected = stamp
        self._report('planning', stamp)

    def refuse(self, stamp: float, reason: str) -> None:
        """Says that nothing came of the path that was expected."""
        self.expected = None
        self._report('refused', stamp, reason)

    def jog(self, wish: Wish | None) -> None:
        """What the source that has the machine wants from now on; None when nobody has it.

        What was being driven brakes along its way and is dropped.
        """
        if wish is not None and self._wish is None and self.is_busy:
            self._newest = self._next = None
            self._is_stopping = not isinstance(self._plan, Hold)
        self.expected = self.expected if wish is None else None
        self._wish = wish

    def note_measured(self, pose: Pose) -> None:
        """Where the joints are measured to be: what a jog mode closes its loop on."""
        self._measured = pose

    def start_cycle(self, cycle: Cycle) -> None:
        """Goes to the cycle's first pose and begins it there.

        Raises Refused or Unreachable, with the moment and the limit, if it cannot be driven.
        """
        self._refuse_while_jogged()
        check_cycle(self._machine, cycle, self.joints, self._dt)
        start = cycle.at(0.0).pose
        self._begin(plan_to(self._machine, self.state, start, self.joints, self._dt), stamp=0.0)
        self._newest, self._next, self._is_stopping, self.expected = None, cycle, False, None

    def stop(self) -> None:
        """Brakes along the way, then holds; what was to come is dropped."""
        self._newest = self._next = self._wish = self.expected = None
        if self._jogging is not None:
            self._is_stopping = True
        elif isinstance(self._plan, Hold):
            self._report('stopped', self._stamp)
        else:
            self._is_stopping = True

    def pause(self, is_paused: bool) -> None:
        """Brakes along the way and stays, or goes on."""
        self.is_paused = is_paused

    def blind(self, is_blind: bool) -> None:
        """As `pause`, apart from the user's own: nobody knows where the joints are."""
        self._is_blind = is_blind

    def override(self, rate: float) -> None:
        """Runs everything at `rate` times its speed; Refused outside [0, 1]."""
        if not 0.0 <= rate <= 1.0:
            raise Refused(f'speed override {rate:g} outside [0, 1]')
        self._override = rate

    def step(self) -> Pose:
        """Advances by one tick and returns the pose to command."""
        if self._jogging is not None or (self._wish is not None and self._is_holding):
            return self._step_jog()
        if isinstance(self._plan, Hold):
            self._rate = self._wanted_rate
        if self._newest is not None:
            goal, self._newest = self._newest, None
            self._take(goal)
        before = self.state.pose
        self._advance()
        pose = self.state.pose
        try:
            self.joints = self._machine.kinematics.inverse(pose, self.joints)
        except Unreachable as error:
            self._begin(Hold(before), self._stamp)
            self._report('stopped', self._stamp, str(error))
            return before
        return pose

    @property
    def _is_holding(self) -> bool:
        return isinstance(self._plan, Hold) and self._newest is None

    def _refuse_while_jogged(self) -> None:
        if self._wish is not None:
            raise Refused(f'{self._wish.source} has the machine')

    def _step_jog(self) -> Pose:
        if self._jogging is None:
            self._jogging = Jogging(self._machine, self.state.pose, self.joints, self._dt)
        jogging = self._jogging
        jogging.step(self._wish, self._wanted_rate, self._measured)
        self.joints = jogging.motion.joints
        if jogging.motion.is_at_rest and (self._wish is None or self._is_stopping):
            result = 'stopped' if self._is_stopping else 'idle'
            self._jogging, self._is_stopping = None, False
            self._begin(Hold(jogging.motion.pose), 0.0)
            self._report(result, 0.0)
        else:
            self.status = MotionStatus('jog', 'moving', 0.0, jogging.reason)
        return jogging.motion.pose

    def _take(self, goal: Goal) -> None:
        """Goes there at once if it can be joined in motion, else stops first and then goes."""
        if self._is_stopping and self._rate > 0.0:
            self._next = goal
            return
        state = self.state
        try:
            move = plan_to(self._machine, state, goal.pose, self.joints, self._dt)
        except Unreachable as error:
            self._report('refused', goal.stamp, str(error))
        except Refused as error:
            if state.is_at_rest:
                self._report('refused', goal.stamp, str(error))
            else:
                self._next, self._is_stopping = goal, True
        else:
            self._next = goal.then
            self._begin(move, goal.stamp)

    def _begin(self, plan: Plan, stamp: float) -> None:
        self._plan, self._time, self._stamp = plan, 0.0, stamp
        if not isinstance(plan, Hold):
            self._report('moving', stamp)

    def _report(self, result: str, stamp: float, reason: str = '') -> None:
        self.status = MotionStatus(MODES[type(self._plan)], result, stamp, reason)

    def _advance(self) -> None:
        rise = min(SPEEDING_UP_RATE * self._dt, self._braking_step)
        self._rate = min(
            self._rate + rise, max(self._rate - self._braking_step, self._wanted_rate)
        )
        self._time += self._rate * self._dt
        if self._is_stopping and self._rate <= 0.0:
            self._settle('stopped')
        elif self._time >= self._plan.duration and not isinstance(self._plan, Hold):
            self._settle('reached')
        elif isinstance(self._plan, TimedPath) and self.status.result == 'moving':
            self.status = replace(self.status, percent=self._plan.percent(self._time))

    def _settle(self, result: str) -> None:
        """The plan is over: hold its last pose, or begin what waits."""
        following, self._next = self._next, None
        wish = self._wish if result == 'stopped' else None
        reason = '' if wish is None else f'{wish.source} took the machine over'
        stamp = self._stamp
        self._begin(Hold(self.state.pose), stamp)
        self._is_stopping = False
        self._rate = self._wanted_rate
        if isinstance(following, Cycle):
            self._rate = 0.0
            self._begin(following, stamp)
        elif isinstance(following, TimedPath):
            self._follow(following, stamp)
        elif isinstance(following, Goal):
            self._take(following)
        else:
            self._report(result, stamp, reason)

    def _follow(self, path: TimedPath, stamp: float) -> None:
        if np.abs(self.joints - path.joints).max() > BRANCH_JUMP:
            self._report('refused', stamp, 'the joints came to the first pose on another branch')
        else:
            self._begin(path, stamp)
