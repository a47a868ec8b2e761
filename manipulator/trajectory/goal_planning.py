"""Planning of goals, while the active plan continues.

Short moves of machines with an explicit inverse are planned within the tick: a stream of goals is
followed closest this way. Other plans are made in a worker, and begin where the active plan will
be LEADS ticks later. A plan that is finished too late is made again with more time, and at last
from rest.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import ManipulatorError, Refused, Unreachable
from manipulator.machine import Machine
from manipulator.planning.goal import Goal, Motion, OnUnreachable
from manipulator.planning.nearest_goal import NearestGoal
from manipulator.planning.plan import Hold, MotionState, Plan
from manipulator.planning.planner import plan_goal
from manipulator.planning.start import Start
from manipulator.planning.stream import Stream
from manipulator.planning.worker import Effort, InPlace, Job, TooLong, Worker
from manipulator.pose import Pose
from manipulator.trajectory.active_plan import ActivePlan

LEADS = (3, 12, 50)
"""Ticks after which a plan is to be joined in motion, at the first, second and third attempt."""

TICK_POSES = 200
"""Poses that may be solved for a plan within a tick: docs/motion.md, section 3."""

NOTABLE = 5
"""Ticks of planning after which that is reported: most plans, and streams of goals, take less."""

STEP = 1e-3
"""Seconds, for differences of joints."""

SAME_POSE = 1e-9
"""m and rad between the start of a plan and the pose that is held."""


@dataclass(frozen=True, eq=False)
class Planned:
    """A plan for a goal, that begins at time `begin` of the plan `source`."""

    goal: Goal
    start: MotionState
    source: Plan
    begin: float
    job: Job[Plan]

    @property
    def is_from_rest(self) -> bool:
        """Whether it begins at rest."""
        return self.start.is_at_rest

    @property
    def is_too_long(self) -> bool:
        """Whether it is done, and would have cost too many poses."""
        return self.job.is_done and isinstance(self.job.error, TooLong)

    def fits(self, active: ActivePlan) -> bool:
        """Whether it can still begin from the active plan."""
        if active.is_hold:
            away = active.state.pose.twist_to(self.start.pose)
            return self.is_from_rest and float(np.abs(away).max()) < SAME_POSE
        return active.plan is self.source and active.time <= self.begin


@dataclass(frozen=True)
class Failed:
    """A goal without a plan, and why; is_final where a plan from rest would not help either."""

    goal: Goal
    error: ManipulatorError
    is_final: bool


class Planning:
    """The newest goal: waiting, being planned, or planned and not yet begun. Changes every tick.

    While one goal is planned, the newest other one waits; those between are dropped.
    """

    def __init__(self, machine: Machine, dt: float, worker: Worker) -> None:
        self._machine, self._dt, self._worker = machine, dt, worker
        self._quick = InPlace(TICK_POSES) if machine.kinematics.is_explicit else None
        self._stream = Stream(0.0 if self._quick else LEADS[0] * dt, Pose.twist_to)
        self._joint_stream = Stream(LEADS[0] * dt, _change)
        self._nearest = NearestGoal(machine)
        self._now = 0.0
        self._newest: Goal | None = None
        self._request: Planned | None = None
        self.ready: Planned | None = None
        self._attempts = self._ticks = 0

    @property
    def goal(self) -> Goal | None:
        """The newest goal, until its plan begins."""
        of_plan = self._request or self.ready
        return self._newest or (None if of_plan is None else of_plan.goal)

    @property
    def is_notable(self) -> bool:
        """Whether a plan has just become worth a report, by how long it takes."""
        return self._request is not None and self._ticks == NOTABLE

    def request(self, goal: Goal, pose: Pose, joints: Array) -> None:
        """Plans a goal at the next `step`; the machine is at `pose`, with joints (n,)."""
        if goal.on_unreachable is OnUnreachable.NEAREST:
            goal = self._nearest.reached(goal, pose, joints)
        self._newest = self._continued(goal)

    def _continued(self, goal: Goal) -> Goal:
        """The goal, with its flow where it continues a stream of poses, or of joints.

        It ends the other one.
        """
        is_simple = goal.then is None or isinstance(goal.then, Goal)
        if is_simple and goal.motion is Motion.JOINT and goal.joints is not None:
            self._stream.continued(goal, None, self._now)
            return self._joint_stream.continued(goal, goal.joints, self._now)
        self._joint_stream.continued(goal, None, self._now)
        is_of_poses = is_simple and goal.motion is not Motion.JOINT and goal.joints is None
        return self._stream.continued(goal, goal.pose if is_of_poses else None, self._now)

    def cancel(self) -> None:
        """Gives up all plans that have not begun."""
        if self._request is not None:
            self._request.job.cancel()
        self._newest = self._request = self.ready = None

    def step(self, active: ActivePlan, joints: Array) -> Failed | None:
        """One tick of planning beside the `active` plan, at joints (n,).

        Afterwards a plan is `ready`, or has failed, or was too late and is made again.
        """
        self._now += self._dt
        if self._newest is not None and self._request is None and self.ready is None:
            goal, self._newest = self._newest, None
            self._attempts = self._ticks = 0
            failed = self._begun(goal, active, joints)
            if failed is not None:
                return failed
        self._ticks += 1
        request = self._request
        if request is None or not request.job.is_done:
            return None
        self._request = None
        try:
            request.job.result()
        except ManipulatorError as error:
            is_final = request.is_from_rest or isinstance(error, Unreachable)
            return Failed(request.goal, error, is_final)
        if request.fits(active):
            self.ready = request
            return None
        self._attempts += 1
        if self._attempts == len(LEADS):
            late = Refused('the plan was finished too late to join it in motion')
            return Failed(request.goal, late, is_final=False)
        return self._begun(request.goal, active, joints)

    def _begun(self, goal: Goal, active: ActivePlan, joints: Array) -> Failed | None:
        """Begins to plan; a goal that the worker does not accept is refused."""
        try:
            self._begin(goal, active, joints)
        except Refused as error:
            return Failed(goal, error, is_final=True)
        return None

    def _begin(self, goal: Goal, active: ActivePlan, joints: Array) -> None:
        """Plans within this tick where that is cheap enough, else in the worker."""
        if self._quick is not None and self._worker.is_beside and self._attempts == 0:
            quick = self._submitted(self._quick, goal, active, joints)
            if not quick.is_too_long:
                self._request = quick
                return
        self._request = self._submitted(self._worker, goal, active, joints)

    def _submitted(self, worker: Worker, goal: Goal, active: ActivePlan, joints: Array) -> Planned:
        """A job for a plan that begins some ticks ahead; joints (n,) are those of now."""
        lead = LEADS[self._attempts] if worker.is_beside and not active.is_hold else 0
        begin = min(active.time + lead * self._dt, active.plan.duration)
        times = np.linspace(active.time, begin, lead + 1)
        at = self._now + lead * self._dt
        ahead = _Ahead(active.plan, times, active.plan.at(begin), joints, at)
        job = worker.submit(partial(self._plan, goal, ahead))
        return Planned(goal, ahead.state, active.plan, begin, job)

    def _plan(self, goal: Goal, ahead: '_Ahead', effort: Effort) -> Plan:
        """Runs in the worker, with the inverse kinematics up to the plan's start."""
        effort.spend(len(ahead.times))
        joints = ahead.joints_at_end(self._machine)
        before = ahead.joints_before_end(self._machine, joints, self._dt)
        start = Start(ahead.state, joints, self._dt, ahead.at, ahead.rates_at_end, before)
        return plan_goal(self._machine, start, goal, effort)


def _change(before: Array, after: Array) -> Array:
    return after - before


@dataclass(frozen=True, eq=False)
class _Ahead:
    """Times (k,) of a plan, with the state at the last and the joints (n,) at the first.

    at: when the last one is, on the clock of `Planning`.
    """

    plan: Plan
    times: Array
    state: MotionState
    joints: Array
    at: float

    @property
    def rates_at_end(self) -> tuple[Array, Array] | None:
        """Rates of the joints, with their derivatives (n,); None for a plan of poses."""
        middle = float(np.clip(self.times[-1], STEP, max(self.plan.duration - STEP, STEP)))
        rows = self.plan.joints_at(middle + STEP * np.array([-1.0, 0.0, 1.0]))
        if rows is None:
            return None
        pulls = (rows[2] - 2.0 * rows[1] + rows[0]) / STEP**2
        rates = (rows[2] - rows[0]) / (2.0 * STEP) + (self.times[-1] - middle) * pulls
        return rates, pulls

    def joints_before_end(self, machine: Machine, joints: Array, dt: float) -> Array | None:
        """The joints (n,) a tick before those at the end; None where another plan had them."""
        if isinstance(self.plan, Hold):
            return joints
        time = float(self.times[-1]) - dt
        if time < 0.0:
            return None
        rows = self.plan.joints_along(machine.kinematics, np.array([time]), joints)
        return rows[0] if bool(np.isfinite(rows).all()) else None

    def joints_at_end(self, machine: Machine) -> Array:
        """The joints (n,) at the last of the times."""
        if len(self.times) == 1:
            return self.joints
        last: Array = self.plan.joints_along(machine.kinematics, self.times, self.joints)[-1]
        return last
