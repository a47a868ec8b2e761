"""Timers that a clock which is set neither stalls nor hurries.

A node's own timers run on the system's clock, and even for those on the monotonic one rclpy's
EventsExecutor, as built for its wheels, waits until a time of the system's clock: set back by an
hour, it rests for an hour (SingleThreadedExecutor does not, but costs a third more: see Choices
in docs/architecture.md). So a thread sleeps, and only wakes the executor up.
"""

import os
import sys
import threading
import time
from collections.abc import Callable

from rclpy.node import Node


class ExecutorCall:
    """A callback for the executor of a node. An error in it ends the process."""

    def __init__(self, node: Node, callback: Callable[[], None]) -> None:
        self._node, self._callback = node, callback
        self._is_due = False

    def request(self) -> None:
        """Has it called, once, however often that is requested before; from any thread."""
        executor = self._node.executor
        if executor is not None and self._node.context.ok() and not self._is_due:
            self._is_due = True
            executor.create_task(self._call)

    def _call(self) -> None:
        self._is_due = False
        has_failed = True
        try:
            self._callback()
            has_failed = False
        finally:
            if has_failed:  # the executor would crash at it, without a message
                sys.excepthook(*sys.exc_info())
                os._exit(1)


class SteadyTimer(threading.Thread):
    """Has the node's executor call back every `period` seconds of the monotonic clock.

    What cannot be called in time is left out, not made up for.
    """

    def __init__(self, node: Node, period: float, callback: Callable[[], None]) -> None:
        super().__init__(name='timer', daemon=True)
        self._period, self._call = period, ExecutorCall(node, callback)
        self.start()

    def run(self) -> None:
        """The thread's work, for as long as the process lives."""
        start, ticks = time.monotonic(), 0
        while True:
            ticks = max(ticks + 1, int((time.monotonic() - start) / self._period))
            time.sleep(max(start + ticks * self._period - time.monotonic(), 0.0))
            self._call.request()
