"""The last latencies, and what people ask of them."""

from collections import deque
from collections.abc import Iterable


class Latencies:
    """Keeps the newest of them, in seconds; adding is safe from another thread."""

    def __init__(self, keep: int = 1000) -> None:
        self._seconds: deque[float] = deque(maxlen=keep)

    def add(self, seconds: float) -> None:
        """One more; negative ones (two clocks) count as zero."""
        self._seconds.append(max(seconds, 0.0))

    def report(self, name: str) -> dict[str, float]:
        """p50 and p99 in milliseconds, under names that say so; empty when there are none."""
        return percentiles_ms(name, tuple(self._seconds))


def percentiles_ms(name: str, seconds: Iterable[float]) -> dict[str, float]:
    """{name}_p50_ms and {name}_p99_ms; empty where there is nothing to sort."""
    ordered = sorted(seconds)
    if not ordered:
        return {}
    p50, p99 = (ordered[min(int(q * len(ordered)), len(ordered) - 1)] for q in (0.5, 0.99))
    return {f'{name}_p50_ms': 1e3 * p50, f'{name}_p99_ms': 1e3 * p99}
