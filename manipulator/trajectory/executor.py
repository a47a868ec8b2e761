"""Executes plans tick by tick: goals in, setpoints out, and every stop along the checked path.

A plan runs in its own time, whose rate goes from 0 (paused) to 1 (full speed). Stopping, pausing
and slowing change the rate alone, so the machine never leaves the path that was checked. A jog
begins and ends at rest: it first brakes the plan, and drops it.
"""

import math
from dataclasses import replace

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused, Unreachable
from manipulator.machine import Machine
from manipulator.planning.cycle import Cycle
from manipulator.planning.flowing import Flowing
from manipulator.planning.goal import Goal
from manipulator.planning.joint_stream import JointMoveInMotion
from manipulator.planning.joint_trajectory import JointTrajectory
from manipulator.planning.path_timing import TimedPath
from manipulator.planning.plan import Hold, MotionState, Plan
from manipulator.planning.point_to_point import MoveInMotion
from manipulator.planning.worker import InPlace, Worker
from manipulator.pose import Pose
from manipulator.states import MotionMode, MotionResult
from manipulator.trajectory.active_plan import ActivePlan, TimeScaling
from manipulator.trajectory.goal_planning import Planned, Planning
from manipulator.trajectory.jogging import AnyJogCommand, Jog
from manipulator.trajectory.motion_status import (
    OVERTAKEN,
    REPLACED,
    STOPPED,
    TAKEN_OVER,
    MotionStatus,
)

AHEAD, AHEAD_ROWS = 0.5, 26
"""Seconds in which the direction of a motion shows, and the poses that are looked at."""


class Executor:
    """Owns the commanded state of one machine from the moment that it is enabled.

    status: what is reported. joints (n,): those of the last setpoint. expected: the stamp of a
    path that is being planned, None without one; dropped: why the last one was given up.
    awaits_arrival: whether a path or cycle waits for `begin_waiting` at its first pose, as where
    joints are measured; is_waiting: whether one does.
    """

    def __init__(
        self, machine: Machine, pose: Pose, joints: Array, dt: float, worker: Worker | None = None
    ) -> None:
        """Begins by holding `pose`, where the joints are; worker: where plans are made."""
        self.status = MotionStatus()
        self.joints = joints
        self._machine = machine
        self._dt = dt
        self._scaling = TimeScaling(machine.motion.braking_rate, dt)
        self._active = ActivePlan(Hold(pose))
        self._planning = Planning(machine, dt, worker or InPlace())
        self._next: Goal | Cycle | TimedPath | None = None
        self.expected: float | None = None
        self.dropped = TAKEN_OVER
        self._jog_command: AnyJogCommand | None = None
        self._jogging: Jog | None = None
        self._measured: Pose | None = None
        self.awaits_arrival = False
        self.is_waiting = False

    @property
    def state(self) -> MotionState:
        """The commanded state, in the plan's own time while a plan is executed."""
        if self._jogging is not None:
            motion = self._jogging.motion
            return MotionState(motion.pose, motion.twist, np.zeros(6))
        return self._active.state

    @property
    def active(self) -> ActivePlan:
        """The plan that is executed, a hold plan at rest."""
        return self._active

    @property
    def newest_stamp(self) -> float:
        """The stamp of the newest goal, active or waiting."""
        waiting = self._planning.goal or self._next
        return waiting.stamp if isinstance(waiting, Goal) else self.status.goal_stamp

    @property
    def pursued(self) -> Pose | None:
        """The newest goal, active or waiting; None for other motion and at rest."""
        waiting = self._planning.goal or self._next
        if isinstance(waiting, Goal):
            return waiting.pose
        return self._active.end.pose if self._active.mode == MotionMode.MOVE else None

    @property
    def joints_to_come(self) -> Array:
        """The joints (n,) at the end of the newest goal; without one, those of now."""
        waiting = self._planning.goal or self._next
        if isinstance(waiting, Goal) and waiting.joints is not None:
            return waiting.joints
        pose = self.pursued
        if pose is None:
            return self.joints
        own = None if waiting is not None else self._active.plan.joints_at(math.inf)
        return self._machine.kinematics.inverse(pose, self.joints) if own is None else own

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves and nothing is about to."""
        is_jogged = self._jogging is not None or self._jog_command is not None
        return self._is_holding and not is_jogged

    @property
    def is_busy(self) -> bool:
        """Whether a goal or a cycle is active, or waits."""
        return not self._is_holding

    @property
    def is_executing(self) -> bool:
        """Whether a plan is executed, neither paused nor braked, or has just reached its end."""
        if self._active.is_hold:
            return self._jogging is None and self.status.result == MotionResult.REACHED
        return self._scaling.target > 0.0

    @property
    def may_slow_down(self) -> bool:
        """Whether a path is executed that has no times of its own."""
        plan = self._active.plan
        return isinstance(plan, TimedPath) and not plan.is_stamped

    @property
    def is_streaming(self) -> bool:
        """Whether a stream of goals is followed."""
        plan = self._active.plan
        return isinstance(plan, MoveInMotion | JointMoveInMotion) and isinstance(
            plan.curve, Flowing
        )

    def slow_down(self, most: float) -> None:
        """Scales the active plan to `most` of its speed, from (0, 1], as fast as it may brake."""
        self._scaling.most = most

    def joints_ahead(self) -> Array:
        """The joints (AHEAD_ROWS, n) with which the active plan goes on for AHEAD seconds."""
        active = self._active
        times = active.time + np.linspace(0.0, AHEAD, AHEAD_ROWS)
        return active.plan.joints_along(self._machine.kinematics, times, self.joints)

    @property
    def own_joints(self) -> Array | None:
        """The joints (n,) to command, where the motion is one of joints and not of poses."""
        if self._jogging is not None:
            return self.joints if self._jogging.is_of_joints else None
        active = self._active
        return None if active.is_hold else active.plan.joints_at(active.time)

    def begin_waiting(self) -> None:
        """Begins the path or cycle that waited for the machine's arrival at its first pose."""
        self.is_waiting = False
        if not isinstance(self._active.plan, Cycle):
            self._scaling.jump()

    def give_up_waiting(self, reason: str) -> None:
        """Drops the path or cycle that waits, and reports it as stopped."""
        stamp = self._active.stamp
        self._begin(Hold(self.state.pose), stamp)
        self._scaling.jump()
        self._report(MotionResult.STOPPED, stamp, reason)

    def pursue(self, goal: Goal) -> None:
        """Plans a goal from the next tick on; of several the newest wins.

        Refused during a jog. The active plan continues until the new one is ready.
        """
        self._refuse_while_jogged()
        self._planning.request(goal, self.state.pose, self.joints)
        self._drop_path(OVERTAKEN)

    def expect(self, stamp: float) -> None:
        """Notes that a path of that stamp is being planned; `dropped` is the reason if it ends."""
        self._refuse_while_jogged()
        self.expected = stamp
        self._report(MotionResult.PLANNING, stamp)

    def refuse(self, stamp: float, reason: str) -> None:
        """Reports the expected path as refused."""
        self.expected = None
        self._report(MotionResult.REFUSED, stamp, reason)

    def begin(self, plan: JointTrajectory, stamp: float) -> None:
        """Begins the expected trajectory, whose first joints are those of this machine at rest."""
        self.expected = None
        self._begin(plan, stamp)

    def brake(self) -> None:
        """Brakes along the path and drops the motion, to begin what is expected from rest."""
        self._drop()
        self._scaling.is_stopping = not self._active.is_hold

    def jog(self, command: AnyJogCommand | None) -> None:
        """The jog command of the owning source from now on; None without an owner.

        The active plan brakes along its path and is dropped.
        """
        if command is not None and self._jog_command is None and self.is_busy:
            self.brake()
        if command is not None:
            self._drop_path(command.takeover)
        self._jog_command = command

    def note_measured(self, pose: Pose) -> None:
        """The measured pose: the feedback of jog modes."""
        self._measured = pose

    def start_cycle(self, cycle: Cycle, stamp: float = 0.0) -> None:
        """Moves to the cycle's first pose and begins it there; checked before anything moves.

        Refused during a jog.
        """
        self.pursue(Goal(cycle.at(0.0).pose, stamp, then=cycle))

    def stop(self) -> None:
        """Brakes along the path, then holds; waiting goals are dropped."""
        stamp, reason = self._to_come
        self._drop()
        self._drop_path(STOPPED)
        self._jog_command = None
        if self._jogging is None and self._active.is_hold:
            self._report(MotionResult.STOPPED, stamp, reason)
        else:
            self._scaling.is_stopping = True

    def close(self) -> None:
        """The machine is released: cancels planning."""
        self._drop()

    def pause(self, is_paused: bool) -> None:
        """Brakes along the path and waits, or continues."""
        self._scaling.is_paused = is_paused

    def blind(self, is_blind: bool) -> None:
        """As `pause`, independent of the user's: the joints' positions are unknown."""
        self._scaling.is_blind = is_blind

    def override(self, rate: float) -> None:
        """Runs everything at `rate` times its speed; Refused outside [0, 1]."""
        self._scaling.override(rate)

    def step(self) -> Pose:
        """Advances by one tick and returns the pose to command."""
        command = self._jog_command
        if self._jogging is None and command is not None and self._is_holding:
            self._jogging = command.begin(self._machine, self.state.pose, self.joints, self._dt)
        if self._jogging is not None:
            return self._step_jog(self._jogging)
        if self._active.is_hold:
            self._scaling.jump()
        self._plan()
        before = self._active
        self._advance()
        pose = self.state.pose
        try:
            own = self.own_joints
            if own is None:
                own = self._machine.kinematics.inverse(pose, self.joints)
            self.joints = own
        except Unreachable as error:
            self._drop()
            held = before.state.pose
            self._begin(Hold(held), self._active.stamp)
            self._report(MotionResult.STOPPED, self._active.stamp, str(error))
            return held
        return pose

    @property
    def _is_holding(self) -> bool:
        return self._active.is_hold and self._planning.goal is None

    @property
    def _to_come(self) -> tuple[float, str]:
        """The stamp of what a stop ends, and the reason if it never began, else ''."""
        waiting = self._planning.goal
        if self.expected is not None:
            return self.expected, STOPPED
        return (self._active.stamp if waiting is None else waiting.stamp), ''

    def _drop_path(self, reason: str) -> None:
        """Drops the expected path, if any."""
        if self.expected is not None:
            self.expected, self.dropped = None, reason

    def _drop(self) -> None:
        """Drops waiting goals and cancels planning."""
        self._next = None
        self._planning.cancel()

    def _refuse_while_jogged(self) -> None:
        if self._jog_command is not None:
            raise Refused(f'{self._jog_command.source} controls the machine')

    def _step_jog(self, jogging: Jog) -> Pose:
        command = self._jog_command
        if command is not None and not jogging.takes(command):
            command = None
        jogging.step(command, self._scaling.target, self._measured)
        self.joints = jogging.motion.joints
        is_stopping = self._scaling.is_stopping
        if jogging.motion.is_at_rest and (command is None or is_stopping):
            result = MotionResult.STOPPED if is_stopping else MotionResult.IDLE
            self._jogging, self._scaling.is_stopping = None, False
            self._begin(Hold(jogging.motion.pose), 0.0)
            self._report(result, 0.0)
        else:
            self.status = MotionStatus(MotionMode.JOG, MotionResult.MOVING, 0.0, jogging.reason)
        return jogging.motion.pose

    def _plan(self) -> None:
        """Plans the newest goal; where that fails it is refused, or planned from rest."""
        if self._scaling.is_stopping and self._scaling.factor > 0.0:
            self._next = self._planning.goal or self._next
            self._planning.cancel()
            return
        failed = self._planning.step(self._active, self.joints)
        if failed is not None and failed.is_final:
            self._report(MotionResult.REFUSED, failed.goal.stamp, str(failed.error))
        elif failed is not None:
            self._next, self._scaling.is_stopping = failed.goal, True
        elif self._planning.is_notable:
            self._report(MotionResult.PLANNING, self.newest_stamp)

    def _join(self, planned: Planned) -> None:
        """Switches to a plan that begins at this tick, or has begun within it."""
        since = 0.0 if self._active.is_hold else self._active.time - planned.begin
        self._next = planned.goal.then
        self._begin(planned.job.result(), planned.goal.stamp, planned.goal.note)
        self._active = self._active.at_time(since)

    def _begin(self, plan: Plan, stamp: float, note: str = '') -> None:
        self._active, self._planning.ready = ActivePlan(plan, stamp, note), None
        self.is_waiting = False
        if not self._active.is_hold:
            self._report(MotionResult.MOVING, stamp, note)

    def _report(self, result: MotionResult, stamp: float, reason: str = '') -> None:
        self.status = MotionStatus(self._active.mode, result, stamp, reason)

    def _advance(self) -> None:
        ready = self._planning.ready
        if ready is not None and self._active.is_hold:
            self._join(ready)
            ready = None
        if not self.is_waiting:
            self._scaling.advance()
        self._active = self._active.at_time(self._active.time + self._scaling.factor * self._dt)
        if ready is not None and self._active.time >= ready.begin:
            self._join(ready)
        if self._scaling.is_stopping and self._scaling.factor <= 0.0:
            self._settle(MotionResult.STOPPED)
        elif self._active.is_over:
            self._settle(MotionResult.REACHED)
        elif self.status.result == MotionResult.MOVING:
            self.status = replace(self.status, percent=self._active.percent)

    def _settle(self, result: MotionResult) -> None:
        """The plan has ended: hold its last pose, or begin the waiting goal."""
        waiting, self._next = self._next, None
        stamp, note, own = self._active.stamp, self._active.note, self.own_joints
        if own is not None:
            self.joints = own
        self._begin(Hold(self.state.pose), stamp)
        self._scaling.is_stopping = False
        self._scaling.jump()
        if isinstance(waiting, (Cycle, TimedPath)):
            self._begin(waiting, stamp)
            self.is_waiting = self.awaits_arrival
            if self.is_waiting or isinstance(waiting, Cycle):
                self._scaling.factor = 0.0
        elif isinstance(waiting, Goal):
            if self._planning.goal is None:
                self._planning.request(waiting, self.state.pose, self.joints)
        else:
            self._report(result, stamp, self._reason if result == MotionResult.STOPPED else note)

    @property
    def _reason(self) -> str:
        """Why a plan was braked, where nobody requested that."""
        if self._jog_command is not None:
            return self._jog_command.takeover
        return REPLACED if self.expected is not None else ''
