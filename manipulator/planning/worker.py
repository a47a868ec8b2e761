"""Planning beside the control loop: one job at a time, bounded, and cancelled on request.

A plan costs milliseconds where the inverse kinematics has a closed form, tenths of a second where
it has none; a tick has ten milliseconds. So the executor submits a task, looks at each tick
whether it is done, and goes on with what it was doing meanwhile.
"""

from collections.abc import Callable
from concurrent.futures import Future
from typing import Generic, Protocol, TypeVar

from manipulator.errors import ManipulatorError

T = TypeVar('T')

MOST_POSES = 300_000
"""Poses that may be solved for one plan, whatever it is: the bound on its time and memory."""


class Cancelled(ManipulatorError):
    """A newer command came: this plan is not needed any more."""


class TooLong(ManipulatorError, ValueError):
    """A plan that costs more poses than it may."""


class Effort:
    """What one plan has cost so far, in poses solved. It changes in the worker's thread alone."""

    def __init__(self, most: int = MOST_POSES, is_cancelled: Callable[[], bool] = bool) -> None:
        self.poses = 0
        self._most = most
        self._is_cancelled = is_cancelled

    @property
    def is_whole(self) -> bool:
        """Whether it is all that a plan may cost, and not only what fits into a tick."""
        return self._most >= MOST_POSES

    def spend(self, poses: int) -> None:
        """Call before solving `poses`: TooLong above the limit, Cancelled after `cancel`."""
        self.poses += poses
        if self._is_cancelled():
            raise Cancelled('replaced by a newer command while it was planned')
        if self.poses > self._most:
            raise TooLong(
                f'planning needs more than {self._most} poses: command a shorter or quicker motion'
            )


Task = Callable[[Effort], T]


class Job(Generic[T]):
    """A task that is running."""

    def __init__(self, future: 'Future[T]', give_up: Callable[[], object]) -> None:
        """give_up: has the task's effort end it."""
        self._future, self._give_up = future, give_up

    @property
    def is_done(self) -> bool:
        """Whether `result` returns at once."""
        return self._future.done()

    def result(self) -> T:
        """What the task returned, or raises what it raised; only once it is done."""
        return self._future.result(timeout=0)

    @property
    def error(self) -> BaseException | None:
        """What the task raised, None where it returned; only once it is done."""
        return self._future.exception(timeout=0)

    def cancel(self) -> None:
        """The result is not needed any more: the task ends at its next `spend`."""
        self._give_up()
        self._future.cancel()


class Worker(Protocol):
    """Where tasks run."""

    @property
    def is_beside(self) -> bool:
        """Whether a task runs beside its submitter, and is done later."""
        ...

    def submit(self, task: Task[T]) -> Job[T]:
        """Begins a task, or has it wait; Refused where too many wait already."""
        ...


class InPlace:
    """Runs each task at once, in the caller's thread: where there is no control loop."""

    is_beside = False

    def __init__(self, most: int = MOST_POSES) -> None:
        """most: poses that a task may solve."""
        self._most = most

    def submit(self, task: Task[T]) -> Job[T]:
        """See `Worker`: the job is done when it comes back."""
        future: Future[T] = Future()
        try:
            future.set_result(task(Effort(self._most)))
        except ManipulatorError as error:
            future.set_exception(error)
        return Job(future, bool)
