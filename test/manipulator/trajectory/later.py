"""A worker whose plans are done after a number of ticks: time as the test wants it."""

from concurrent.futures import Future
from threading import Event

from manipulator.errors import ManipulatorError
from manipulator.trajectory.worker import Effort, Job


class Later:
    """Works a task out when its ticks are over; `tick` lets one pass."""

    is_beside = True

    def __init__(self, ticks):
        self.ticks = ticks
        self.waiting = []
        self.cancelled = 0

    def submit(self, task):
        future, cancelled = Future(), Event()
        self.waiting.append([self.ticks, task, future, cancelled])
        return Job(future, cancelled)

    def tick(self):
        for entry in self.waiting:
            entry[0] -= 1
        done = [entry for entry in self.waiting if entry[0] < 0]
        self.waiting = [entry for entry in self.waiting if entry[0] >= 0]
        for _, task, future, cancelled in done:
            if cancelled.is_set():
                self.cancelled += 1
                continue
            try:
                future.set_result(task(Effort()))
            except ManipulatorError as error:
                future.set_exception(error)
