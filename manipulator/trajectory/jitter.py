"""How late the ticks of a loop come."""

from collections import deque


class Jitter:
    """The lateness of the last thousand ticks against the period, in seconds."""

    def __init__(self, period: float) -> None:
        self._period = period
        self._last: float | None = None
        self._lateness: deque[float] = deque(maxlen=1000)

    def tick(self, now: float) -> float:
        """Notes that a tick begins now; returns the seconds since the last one, 0 at first."""
        elapsed = 0.0 if self._last is None else now - self._last
        if self._last is not None:
            self._lateness.append(abs(elapsed - self._period))
        self._last = now
        return elapsed

    def quantile(self, q: float) -> float:
        """The q-quantile of the lateness, 0 before the second tick."""
        if not self._lateness:
            return 0.0
        return sorted(self._lateness)[int(q * (len(self._lateness) - 1))]
