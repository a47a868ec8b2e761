"""Playing plans tick by tick: goals in, setpoints out, and every stop along the checked way.

A plan runs in its own time, whose rate goes from 0 (paused) to 1 (full speed). Stopping, pausing
and slowing change the rate alone, so the machine never leaves the way that was checked. A jog
begins and ends at rest: it first brakes the plan, and drops it.
"""

from dataclasses import replace

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused, Unreachable
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.trajectory.active_plan import Pace, Playing
from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.goal import Goal
from manipulator.trajectory.jogging import Jogging, Wish
from manipulator.trajectory.joint_move import JointMove
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.path_timing import TimedPath
from manipulator.trajectory.plan import Hold, MotionState, Plan
from manipulator.trajectory.planning import Planned, Planning
from manipulator.trajectory.worker import InPlace, Worker

OVERTAKEN = 'a newer command came while the path was worked out'
STOPPED = 'stopped before it began'
TAKEN_OVER = 'the machine was taken over anew while the path was worked out'
"""Why a path that was expected is not driven."""


class Executor:
    """Owns the commanded state of one machine from the moment that it is enabled."""

    def __init__(
        self, machine: Machine, pose: Pose, joints: Array, dt: float, worker: Worker | None = None
    ) -> None:
        """Begins by holding `pose`, where the joints are; worker: where plans are worked out."""
        self.status = MotionStatus()
        self.joints = joints
        self._machine = machine
        self._dt = dt
        self._pace = Pace(machine.motion.braking_rate, dt)
        self._playing = Playing(Hold(pose))
        self._planning = Planning(machine, dt, worker or InPlace())
        self._next: Goal | Cycle | TimedPath | None = None
        self.expected: float | None = None
        self.dropped = TAKEN_OVER
        self._wish: Wish | None = None
        self._jogging: Jogging | None = None
        self._measured: Pose | None = None

    @property
    def state(self) -> MotionState:
        """The commanded state, in the plan's own time while a plan is played."""
        if self._jogging is not None:
            motion = self._jogging.motion
            return MotionState(motion.pose, motion.twist, np.zeros(6))
        return self._playing.state

    @property
    def newest_stamp(self) -> float:
        """The stamp of the newest goal, whether it is being driven or still waits."""
        waiting = self._planning.goal or self._next
        return waiting.stamp if isinstance(waiting, Goal) else self.status.goal_stamp

    @property
    def pursued(self) -> Pose | None:
        """The newest goal that is driven to or waits; None for other motion and at rest."""
        waiting = self._planning.goal or self._next
        if isinstance(waiting, Goal):
            return waiting.pose
        return self._playing.end.pose if self._playing.mode == 'move' else None

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves and nothing is about to."""
        is_jogged = self._jogging is not None or self._wish is not None
        return self._is_holding and not is_jogged

    @property
    def is_busy(self) -> bool:
        """Whether a goal or a cycle is being driven, or waits."""
        return not self._is_holding

    def pursue(self, goal: Goal) -> None:
        """Has a goal planned from the next tick on; of several the newest wins.

        Refused during a jog. What is driven goes on until the plan is there.
        """
        self._refuse_while_jogged()
        self._planning.ask(goal)
        self._drop_path(OVERTAKEN)

    def expect(self, stamp: float) -> None:
        """A path is being worked out; `expected` is its stamp until `dropped` says why not."""
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
            self._drop()
            self._pace.is_stopping = not self._playing.is_hold
        if wish is not None:
            self._drop_path(_taken_over_by(wish))
        self._wish = wish

    def note_measured(self, pose: Pose) -> None:
        """Where the joints are measured to be: what a jog mode closes its loop on."""
        self._measured = pose

    def start_cycle(self, cycle: Cycle, stamp: float = 0.0) -> None:
        """Goes to the cycle's first pose and begins it there; it is checked before anything moves.

        Refused during a jog.
        """
        self.pursue(Goal(cycle.at(0.0).pose, stamp, then=cycle))

    def stop(self) -> None:
        """Brakes along the way, then holds; what was to come is dropped."""
        stamp, reason = self._to_come
        self._drop()
        self._drop_path(STOPPED)
        self._wish = None
        if self._jogging is None and self._playing.is_hold:
            self._report('stopped', stamp, reason)
        else:
            self._pace.is_stopping = True

    def close(self) -> None:
        """The machine is let go of: nothing is planned any more."""
        self._drop()

    def pause(self, is_paused: bool) -> None:
        """Brakes along the way and stays, or goes on."""
        self._pace.is_paused = is_paused

    def blind(self, is_blind: bool) -> None:
        """As `pause`, apart from the user's own: nobody knows where the joints are."""
        self._pace.is_blind = is_blind

    def override(self, rate: float) -> None:
        """Runs everything at `rate` times its speed; Refused outside [0, 1]."""
        self._pace.override(rate)

    def step(self) -> Pose:
        """Advances by one tick and returns the pose to command."""
        if self._jogging is not None or (self._wish is not None and self._is_holding):
            return self._step_jog()
        if self._playing.is_hold:
            self._pace.jump()
        self._plan()
        before = self.state.pose
        self._advance()
        pose = self.state.pose
        try:
            self.joints = self._machine.kinematics.inverse(pose, self._near)
        except Unreachable as error:
            self._drop()
            self._begin(Hold(before), self._playing.stamp)
            self._report('stopped', self._playing.stamp, str(error))
            return before
        return pose

    @property
    def _is_holding(self) -> bool:
        return self._playing.is_hold and self._planning.goal is None

    @property
    def _near(self) -> Array:
        """The joints to stay near: those of the plan, where it says them."""
        plan = self._playing.plan
        return plan.joints_at(self._playing.time) if isinstance(plan, JointMove) else self.joints

    @property
    def _to_come(self) -> tuple[float, str]:
        """The stamp of what a stop ends, and why it then never began, '' for what is driven."""
        waiting = self._planning.goal
        if self.expected is not None:
            return self.expected, STOPPED
        return (self._playing.stamp if waiting is None else waiting.stamp), ''

    def _drop_path(self, reason: str) -> None:
        """The path that was expected, if any, does not come."""
        if self.expected is not None:
            self.expected, self.dropped = None, reason

    def _drop(self) -> None:
        """What was to come does not come."""
        self._next = None
        self._planning.cancel()

    def _refuse_while_jogged(self) -> None:
        if self._wish is not None:
            raise Refused(f'{self._wish.source} has the machine')

    def _step_jog(self) -> Pose:
        if self._jogging is None:
            self._jogging = Jogging(self._machine, self.state.pose, self.joints, self._dt)
        jogging = self._jogging
        jogging.step(self._wish, self._pace.wanted, self._measured)
        self.joints = jogging.motion.joints
        is_stopping = self._pace.is_stopping
        if jogging.motion.is_at_rest and (self._wish is None or is_stopping):
            result = 'stopped' if is_stopping else 'idle'
            self._jogging, self._pace.is_stopping = None, False
            self._begin(Hold(jogging.motion.pose), 0.0)
            self._report(result, 0.0)
        else:
            self.status = MotionStatus('jog', 'moving', 0.0, jogging.reason)
        return jogging.motion.pose

    def _plan(self) -> None:
        """Has the newest goal planned; one without a plan is refused, or planned from rest."""
        if self._pace.is_stopping and self._pace.rate > 0.0:
            self._next = self._planning.goal or self._next
            self._planning.cancel()
            return
        failed = self._planning.step(self._playing, self.joints)
        if failed is not None and failed.is_final:
            self._report('refused', failed.goal.stamp, str(failed.error))
        elif failed is not None:
            self._next, self._pace.is_stopping = failed.goal, True
        elif self._planning.is_notable:
            self._report('planning', self.newest_stamp)

    def _join(self, planned: Planned) -> None:
        """Goes over to a plan that begins at this tick, or has begun within it."""
        since = 0.0 if self._playing.is_hold else self._playing.time - planned.begin
        self._next = planned.goal.then
        self._begin(planned.job.result(), planned.goal.stamp)
        self._playing.time = since

    def _begin(self, plan: Plan, stamp: float) -> None:
        self._playing, self._planning.ready = Playing(plan, stamp), None
        if not self._playing.is_hold:
            self._report('moving', stamp)

    def _report(self, result: str, stamp: float, reason: str = '') -> None:
        self.status = MotionStatus(self._playing.mode, result, stamp, reason)

    def _advance(self) -> None:
        ready = self._planning.ready
        if ready is not None and self._playing.is_hold:
            self._join(ready)
            ready = None
        self._pace.advance()
        self._playing.time += self._pace.rate * self._dt
        if ready is not None and self._playing.time >= ready.begin:
            self._join(ready)
        if self._pace.is_stopping and self._pace.rate <= 0.0:
            self._settle('stopped')
        elif self._playing.is_over:
            self._settle('reached')
        elif self.status.result == 'moving':
            self.status = replace(self.status, percent=self._playing.percent)

    def _settle(self, result: str) -> None:
        """The plan is over: hold its last pose, or begin what waits."""
        following, self._next = self._next, None
        stamp = self._playing.stamp
        self._begin(Hold(self.state.pose), stamp)
        self._pace.is_stopping = False
        self._pace.jump()
        if isinstance(following, Cycle):
            self._pace.rate = 0.0
            self._begin(following, stamp)
        elif isinstance(following, TimedPath):
            self._begin(following, stamp)
        elif isinstance(following, Goal):
            if self._planning.goal is None:
                self._planning.ask(following)
        else:
            wish = self._wish if result == 'stopped' else None
            self._report(result, stamp, _taken_over_by(wish) if wish else '')


def _taken_over_by(wish: Wish) -> str:
    return f'{wish.source} took the machine over'
