"""Planning of paths and joint trajectories, while the active plan continues.

They are expected from their arrival until they are planned. Then a path is pursued like a goal; a
trajectory begins where the machine is at rest, by its stamp. Any newer command replaces them.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Protocol, Union

from manipulator.arrays import Array
from manipulator.errors import ManipulatorError, Refused
from manipulator.machine import Machine
from manipulator.planning.goal import Goal
from manipulator.planning.joint_points import JointPoints
from manipulator.planning.joint_trajectory import (
    JointStart,
    JointTrajectory,
    plan_joint_trajectory,
)
from manipulator.planning.orientation import OrientationRule
from manipulator.planning.path_timing import PathRequest, TimedPath, plan_path
from manipulator.planning.worker import Effort, Job, Task, Worker
from manipulator.pose import Pose
from manipulator.states import MotionResult
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.motion_status import OVERTAKEN, MotionNews, MotionStatus
from manipulator.trajectory.supervisor import MotionSupervisor

Outcome = Union[TimedPath, Pose, JointTrajectory, 'TrajectoryGoal']

LEAD = 0.1
"""Seconds after its arrival at which a trajectory begins whose start is past: it is planned."""


class Expected(Protocol):
    """A path or a trajectory, known to its sender by its stamp."""

    @property
    def stamp(self) -> float:
        """That of the message."""
        ...

    @property
    def is_from_rest(self) -> bool:
        """Whether it is planned from where the machine comes to rest."""
        ...

    def begins_at(self, now: float) -> float:
        """When it begins, where it is planned from `now` on, monotonic (s)."""
        ...

    def task(self, machine: Machine, executor: Executor, dt: float, begin: float) -> Task[Outcome]:
        """What plans it, to begin at `begin`."""
        ...


@dataclass(frozen=True, eq=False)
class PathGoal:
    """A path to execute, known to its sender by the stamp of the message.

    read: returns the request; called where the path is planned, because thousands of poses take
    their time; raises InvalidInput. is_of_platform: the poses are the platform's in the base
    frame, else the pivot's in the work frame. orientation: where the poses' comes from.
    """

    stamp: float
    read: Callable[[], PathRequest]
    is_of_platform: bool
    orientation: OrientationRule = field(default_factory=OrientationRule)
    is_from_rest = False

    def begins_at(self, now: float) -> float:
        """See `Expected`: as soon as it is planned."""
        return now

    def task(self, machine: Machine, executor: Executor, dt: float, begin: float) -> Task[Outcome]:
        """See `Expected`."""
        start, near = executor.state.pose, executor.joints
        return lambda effort: self.planned(machine, start, near, dt, effort)

    def planned(
        self, machine: Machine, start: Pose, near: Array, dt: float, effort: Effort
    ) -> TimedPath | Pose:
        """See `plan_path`; start: the pivot's pose in the work frame, from which it begins."""
        frames = machine.frames
        start = frames.platform(start) if self.is_of_platform else start
        request = self.read().oriented(self.orientation, start)
        if self.is_of_platform:
            request = replace(request, poses=frames.pivot(request.poses))
        return plan_path(machine, request, near, dt, effort)


@dataclass(frozen=True, eq=False)
class TrajectoryGoal:
    """A joint trajectory to execute; read: as that of `PathGoal`.

    starts_at: monotonic (s), where its stamp names a time; None: as soon as it is planned.
    tolerance (n,): how far its first point may be from where the machine stands, rad or m.
    points: once it has been read, which comes before the motion under way is braked for it.
    """

    stamp: float
    read: Callable[[], JointPoints]
    tolerance: Array
    starts_at: float | None = None
    points: JointPoints | None = None
    is_from_rest = True

    def read_by(self, effort: Effort) -> 'TrajectoryGoal':
        """With its points; raises InvalidInput."""
        return replace(self, points=self.read())

    def begins_at(self, now: float) -> float:
        """See `Expected`."""
        return now if self.starts_at is None else max(self.starts_at, now + LEAD)

    def task(self, machine: Machine, executor: Executor, dt: float, begin: float) -> Task[Outcome]:
        """See `Expected`: of a trajectory that has begun, what is left of it."""
        start = JointStart(executor.state.pose, executor.joints, dt, self.tolerance)
        since = 0.0 if self.starts_at is None else begin - self.starts_at

        def plan(effort: Effort) -> JointTrajectory:
            points = self.points or self.read()
            return plan_joint_trajectory(machine, start, points.after(since), effort)

        return plan


class PathPlanning:
    """The newest path or trajectory that is expected, if any; `step` is called at every tick."""

    def __init__(
        self, supervisor: MotionSupervisor, dt: float, worker: Worker, news: MotionNews
    ) -> None:
        self._supervisor, self._dt, self._worker, self._news = supervisor, dt, worker, news
        self._newest: Expected | None = None
        self._begin_at = 0.0
        self._job: Job[Outcome] | None = None

    def begin(self, path: Expected) -> None:
        """Plans it, in place of the one before; Refused as `Executor.expect`."""
        executor = self._supervisor.executor
        executor.expect(path.stamp)
        self._drop(OVERTAKEN)
        self._newest = path

    def step(self, now: float) -> None:
        """Begins the path once it is planned, and its time has come; reports it if dropped."""
        if self._newest is None:
            return
        reason = self._unexpected
        if reason:
            self._drop(reason)
            return
        executor = self._supervisor.executor
        if self._job is None:
            self._submit(self._newest, executor, now)
        elif self._job.is_done and (self._job.error or now >= self._begin_at):
            self._pursue(self._newest, self._job, executor)

    def cancel(self) -> None:
        """Gives it up."""
        if self._job is not None:
            self._job.cancel()
        self._job = self._newest = None

    def _submit(self, path: Expected, executor: Executor, now: float) -> None:
        """Begins to plan it, or to read what is planned from rest only."""
        self._begin_at = now
        if isinstance(path, TrajectoryGoal) and path.points is None:
            task: Task[Outcome] = path.read_by
        elif path.is_from_rest and not executor.is_at_rest:
            return
        else:
            self._begin_at = path.begins_at(now)
            task = path.task(self._supervisor.machine, executor, self._dt, self._begin_at)
        try:
            self._job = self._worker.submit(task)
        except Refused as error:
            self.cancel()
            executor.refuse(path.stamp, str(error))

    def _drop(self, reason: str) -> None:
        """Gives up a path, if any, and reports it as stopped."""
        if self._newest is not None:
            stamp, mode = self._newest.stamp, self._supervisor.status.mode
            self.cancel()
            self._news.add(MotionStatus(mode, MotionResult.STOPPED, stamp, reason))

    def _pursue(self, path: Expected, job: Job[Outcome], executor: Executor) -> None:
        self._job = self._newest = None
        try:
            outcome = job.result()
        except ManipulatorError as error:
            executor.refuse(path.stamp, str(error))
            return
        if isinstance(outcome, TrajectoryGoal):
            self._newest = outcome
            executor.brake()
        elif isinstance(outcome, JointTrajectory):
            executor.begin(outcome, path.stamp)
        elif isinstance(outcome, Pose):
            executor.pursue(Goal(outcome, path.stamp))
        else:
            executor.pursue(Goal(outcome.at(0.0).pose, path.stamp, then=outcome))

    @property
    def _unexpected(self) -> str:
        """Why the path is not expected any more, '' while it is."""
        try:
            executor = self._supervisor.executor
        except Refused as refusal:
            return str(refusal)
        is_expected = self._newest is not None and executor.expected == self._newest.stamp
        return '' if is_expected else executor.dropped
