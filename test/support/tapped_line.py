"""A line that keeps every message which the host sends, and when it came."""

import threading
import time
from pathlib import Path

from bridge.fake.fake_line import FakeLine
from bridge.framing import FrameReader
from bridge.protocol import Message


class Tap:
    """Keeps every message which the host sends, and when it came."""

    def __init__(self) -> None:
        self._heard: list[tuple[float, Message]] = []
        self._lock = threading.Lock()
        self._reader = FrameReader()

    def note(self, received: bytes) -> None:
        """Bytes that the host sent, in the line's thread."""
        with self._lock:
            now = time.monotonic()
            self._heard += [(now, frame.message) for frame in self._reader.feed(received)]

    def frames(
        self, kind: type | tuple[type, ...] = object, since: float = float('-inf')
    ) -> list[tuple[float, Message]]:
        """(time, message) of each message of a kind."""
        with self._lock:
            return [(t, m) for t, m in self._heard if t >= since and isinstance(m, kind)]


class TappedLine(FakeLine):
    """A line with a tap on what the host sends."""

    def __init__(self, path: Path, tap: Tap) -> None:
        super().__init__(path)
        self._tap = tap

    def another(self) -> 'TappedLine':
        """At the same path, with the same tap."""
        return TappedLine(self.path, self._tap)

    def read(self) -> bytes:
        """As of any line."""
        received = super().read()
        self._tap.note(received)
        return received
