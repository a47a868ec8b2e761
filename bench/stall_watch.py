"""Whether the computer itself stands still: a process asleep on every core, and how late it wakes.

What else the computer computes delays a sleeper by a few milliseconds. Only a core that was taken
away altogether, as the host of a virtual machine does, makes it late by a tenth of a second.
"""

import os
import subprocess
import sys
import threading
import time

NAP = 0.02
STALL = 0.1
"""Seconds too late that are called a stall."""


class StallWatch:
    """A context manager around the process; it reads one line per stall."""

    def __init__(self) -> None:
        self._stalls: list[tuple[float, float]] = []

    def __enter__(self) -> 'StallWatch':
        """Starts the process."""
        command, pipe = [sys.executable, __file__], subprocess.PIPE
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
        threading.Thread(target=self._read, daemon=True).start()
        return self

    def __exit__(self, *exception: object) -> None:
        """Ends the process."""
        self.process.kill()
        self.process.wait()

    def _read(self) -> None:
        for line in self.process.stdout or ():
            ended, seconds = map(float, line.split())
            self._stalls.append((ended, seconds))

    def longest(self, since: float = float('-inf')) -> float:
        """Seconds of the longest stall that ended after a time (time.monotonic), or zero."""
        return max((took for ended, took in self._stalls if ended >= since), default=0.0)

    @property
    def summary(self) -> str:
        """The longest stall of all, in words."""
        longest = self.longest()
        return f'{longest:.1f} s' if longest else f'less than {STALL:g} s'


def watch(core: int) -> None:
    """Prints when a stall of a core ended and how long it was, for good."""
    os.sched_setaffinity(0, {core})  # of this thread
    while True:
        due = time.monotonic() + NAP
        time.sleep(NAP)
        now = time.monotonic()
        if now - due > STALL:
            print(f'{now} {now - due}\n', end='', flush=True)


if __name__ == '__main__':
    for core in os.sched_getaffinity(0):
        threading.Thread(target=watch, args=(core,), daemon=True).start()
    sys.stdin.read()  # its end is that of the process that asks
