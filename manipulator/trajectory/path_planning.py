"""Planning of paths, while the active plan continues.

A path is expected from its arrival until it is planned; then it is pursued like a goal. Any newer
command replaces it.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from manipulator.arrays import Array
from manipulator.errors import ManipulatorError, Refused
from manipulator.machine import Machine
from manipulator.planning.goal import Goal
from manipulator.planning.orientation import OrientationRule
from manipulator.planning.path_timing import PathRequest, TimedPath, plan_path
from manipulator.planning.worker import Effort, Job, Worker
from manipulator.pose import Pose
from manipulator.states import MotionResult
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.motion_status import OVERTAKEN, MotionNews, MotionStatus
from manipulator.trajectory.supervisor import MotionSupervisor


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


class PathPlanning:
    """The newest path that is expected, if any; `step` is called at every tick."""

    def __init__(
        self, supervisor: MotionSupervisor, dt: float, worker: Worker, news: MotionNews
    ) -> None:
        self._supervisor, self._dt, self._worker, self._news = supervisor, dt, worker, news
        self._stamp = 0.0
        self._job: Job[TimedPath | Pose] | None = None

    def begin(self, path: PathGoal) -> None:
        """Plans it, in place of the one before; Refused as `Executor.expect`."""
        executor, machine = self._supervisor.executor, self._supervisor.machine
        start, near, dt = executor.state.pose, executor.joints, self._dt
        executor.expect(path.stamp)
        self._drop(OVERTAKEN)
        try:
            self._job = self._worker.submit(lambda e: path.planned(machine, start, near, dt, e))
            self._stamp = path.stamp
        except Refused as error:
            executor.refuse(path.stamp, str(error))

    def step(self) -> None:
        """Pursues the path once it is planned; reports it where it was dropped."""
        if self._job is None:
            return
        reason = self._unexpected
        if reason:
            self._drop(reason)
        elif self._job.is_done:
            job, self._job = self._job, None
            self._pursue(job, self._supervisor.executor)

    def cancel(self) -> None:
        """Gives it up."""
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def _drop(self, reason: str) -> None:
        """Gives up a path, if any, and reports it as stopped."""
        if self._job is not None:
            self.cancel()
            mode = self._supervisor.status.mode
            self._news.add(MotionStatus(mode, MotionResult.STOPPED, self._stamp, reason))

    def _pursue(self, job: 'Job[TimedPath | Pose]', executor: Executor) -> None:
        try:
            outcome = job.result()
        except ManipulatorError as error:
            executor.refuse(self._stamp, str(error))
            return
        if isinstance(outcome, Pose):
            executor.pursue(Goal(outcome, self._stamp))
        else:
            executor.pursue(Goal(outcome.at(0.0).pose, self._stamp, then=outcome))

    @property
    def _unexpected(self) -> str:
        """Why the path is not expected any more, '' while it is."""
        try:
            executor = self._supervisor.executor
        except Refused as refusal:
            return str(refusal)
        return '' if executor.expected == self._stamp else executor.dropped
