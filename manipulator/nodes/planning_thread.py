"""The thread in which a node's plans are made, beside the control loop."""

import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import Any, TypeVar

from manipulator.errors import Refused
from manipulator.planning.worker import Effort, Job, Task

T = TypeVar('T')

MOST_WAITING = 8
"""Jobs that may wait for the one that is being worked on."""

SWITCH_INTERVAL = 0.001
"""Seconds after which the worker lets the control loop go on (CPython's default: 5 ms)."""


class PlanningThread:
    """A `Worker` of one thread beside a control loop: one task after the other."""

    is_beside = True

    def __init__(self) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL)
        self._pool = ThreadPoolExecutor(1, thread_name_prefix='planning')
        self._unfinished: list[Job[Any]] = []

    def submit(self, task: Task[T]) -> Job[T]:
        """See `Worker`."""
        self._unfinished = [job for job in self._unfinished if not job.is_done]
        if len(self._unfinished) > MOST_WAITING:
            raise Refused(f'{MOST_WAITING} plans wait already: try again')
        cancelled = Event()
        future = self._pool.submit(task, Effort(is_cancelled=cancelled.is_set))
        self._unfinished.append(Job(future, cancelled.set))
        return self._unfinished[-1]

    def close(self) -> None:
        """Gives up what waits and what is being worked on, and does not wait for its end."""
        for job in self._unfinished:
            job.cancel()
        self._pool.shutdown(wait=False)
