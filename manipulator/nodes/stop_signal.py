"""Signals to end a process (Ctrl-C, a closed window) as a flag that is looked at between steps."""

import signal
from collections.abc import Iterable

from manipulator.errors import ManipulatorError

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(ManipulatorError):
    """Ctrl-C, or a signal to end the process."""


class StopSignal:
    """These signals as a flag, and as an exception at the next `check`."""

    def __init__(self, numbers: Iterable[int] = ENDING) -> None:
        self.is_set = False
        for number in numbers:
            signal.signal(number, self._set)

    def check(self) -> None:
        """Raises Interrupted after a signal."""
        if self.is_set:
            raise Interrupted('interrupted')

    def _set(self, number: int, frame: object) -> None:
        self.is_set = True
