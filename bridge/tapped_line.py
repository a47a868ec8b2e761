"""A line that keeps every message which the host sends, and when it came."""

import threading
import time

from bridge.fake_line import FakeLine
from bridge.framing import FrameReader


class Tap:
    """Keeps every message which the host sends, and when it came."""

    def __init__(self):
        self._heard = []
        self._lock = threading.Lock()
        self._reader = FrameReader()

    def note(self, received):
        with self._lock:
            now = time.monotonic()
            self._heard += [(now, frame.message) for frame in self._reader.feed(received)]

    def heard(self, kind=object, since=float('-inf')):
        """(time, message) of each message of a kind."""
        with self._lock:
            return [(t, m) for t, m in self._heard if t >= since and isinstance(m, kind)]


class TappedLine(FakeLine):
    """A line with a tap on what the host sends."""

    def __init__(self, path, tap):
        super().__init__(path)
        self._tap = tap

    def another(self):
        return TappedLine(self.path, self._tap)

    def read(self):
        received = super().read()
        self._tap.note(received)
        return received
