"""Simulated time: what is due is called in the order of its times, and of the asking."""

import heapq
import itertools
from collections import deque

START = 1000.0
EPOCH = 1.7e9
"""What the system's clocks say when monotonic time is zero, s."""


class Timeline:
    """The one clock; `now` is monotonic, in seconds."""

    def __init__(self):
        self.now = START
        self._due = []
        self._order = itertools.count()

    def after(self, seconds, act):
        heapq.heappush(self._due, (self.now + seconds, next(self._order), act))

    def run(self, seconds):
        """Lets time pass."""
        end = self.now + seconds
        while self._due and self._due[0][0] <= end:
            self.now, _, act = heapq.heappop(self._due)
            act()
        self.now = end


class Process:
    """Handles what its links bring and its timers ask, unless it is frozen or dead.

    clock_offset: by how much its computer's clock is ahead, in seconds.
    """

    def __init__(self, timeline):
        self.timeline = timeline
        self.clock_offset = 0.0
        self._is_frozen = self._is_dead = False
        self._waiting = []

    @property
    def now(self):
        return self.timeline.now

    @property
    def stamp(self):
        """What its computer's clock says."""
        return EPOCH + self.now + self.clock_offset

    def freeze(self, seconds):
        """Nothing is handled for so long; links keep what their depth allows."""
        self._is_frozen = True
        self.timeline.after(seconds, self._thaw)

    def kill(self):
        """Nothing is handled any more; see World.restart."""
        self._is_dead = True

    def every(self, period, act):
        """From now on; what cannot be called in time is left out, but for one."""
        is_missed = False

        def catch_up():
            nonlocal is_missed
            is_missed = False
            act()

        def tick():
            nonlocal is_missed
            if self._is_dead:
                return
            self.timeline.after(period, tick)
            if not self._is_frozen:
                act()
            elif not is_missed:
                is_missed = True
                self._waiting.append(catch_up)

        self.timeline.after(period, tick)

    def handle(self, act):
        """Calls it, now or once the process is no longer frozen."""
        if self._is_dead:
            return
        if self._is_frozen:
            self._waiting.append(act)
        else:
            act()

    def _thaw(self):
        self._is_frozen = False
        waiting, self._waiting = self._waiting, []
        for act in waiting:
            self.handle(act)


class Link:
    """Carries values to a process: each after `delay`, the newest `depth` while it is frozen.

    loses: asked for each value whether it is lost.
    """

    def __init__(self, to, accept, delay=0.0005, depth=1):
        self.delay = delay
        self.loses = lambda: False
        self._to, self._accept = to, accept
        self._arrived = deque(maxlen=depth)

    def send(self, *value):
        if not self.loses():
            self._to.timeline.after(self.delay, lambda: self._arrive(value))

    def lead_to(self, to, accept):
        """Another process listens from now on."""
        self._to, self._accept = to, accept
        self._arrived.clear()

    def _arrive(self, value):
        self._arrived.append(value)
        self._to.handle(self._take)

    def _take(self):
        if self._arrived:  # else a newer value took its place
            self._accept(*self._arrived.popleft())


class Line(Link):
    """Carries bytes; a process reads all that wait, as from a port."""

    def __init__(self, to, accept):
        super().__init__(to, accept, depth=None)

    def _take(self):
        if self._arrived:  # else they were read with those before
            received = b''.join(part for (part,) in self._arrived)
            self._arrived.clear()
            self._accept(received)
