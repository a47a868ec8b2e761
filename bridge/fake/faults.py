"""What goes wrong on lines and boards: on request, and at random from a seed; no clock, no port.

The fake board applies it (board_faults.py, faulty_bytes.py). `now` is monotonic, in seconds.
"""

import enum
from collections import Counter
from random import Random


class FaultKind(enum.Enum):
    """A failure of the line or the board; the values are the names for people."""

    DROP = 'drop'
    DUPLICATE = 'duplicate'
    CORRUPT = 'corrupt'
    DELAY = 'delay'
    SPLIT = 'split'
    UNPLUG = 'unplug'
    RESET = 'reset'
    MUTE = 'mute'
    VERSION = 'version'
    STUCK = 'stuck'
    UNDERVOLTAGE = 'undervoltage'


LONGEST = {
    FaultKind.DROP: 0.5,
    FaultKind.DUPLICATE: 0.5,
    FaultKind.CORRUPT: 0.5,
    FaultKind.DELAY: 0.5,
    FaultKind.SPLIT: 0.5,
    FaultKind.UNPLUG: 1.0,
    FaultKind.RESET: 0.0,
    FaultKind.MUTE: 1.0,
    FaultKind.VERSION: 1.5,
    FaultKind.STUCK: 1.0,
    FaultKind.UNDERVOLTAGE: 1.0,
}
"""Seconds that a fault may last; a random one lasts a tenth of it or more."""

LINE_FAULTS = (
    FaultKind.DROP,
    FaultKind.DUPLICATE,
    FaultKind.CORRUPT,
    FaultKind.DELAY,
    FaultKind.SPLIT,
)
WEIGHTS = {kind: 4 if kind in LINE_FAULTS else 1 for kind in FaultKind}
"""How often a fault comes, against the others: lines are worse than boards."""

MINUTE = 60.0


class Faults:
    """Which faults there are now: those asked for by `inject`, and random ones.

    The same seed makes the same faults at the same times, `per_minute` of them on average. One
    that comes again before its end lasts longer.
    """

    def __init__(self, seed: int = 0, per_minute: float = 0.0) -> None:
        self.counts: Counter[FaultKind] = Counter()
        self._random = Random(seed)
        self._per_second = per_minute / MINUTE
        self._next_at: float | None = None
        self._asked: list[FaultKind] = []
        self._ends: dict[FaultKind, float] = {}

    @property
    def active(self) -> frozenset[FaultKind]:
        """Those that have begun and not ended."""
        return frozenset(self._ends)

    def inject(self, kind: FaultKind) -> None:
        """Begins one at the next `advance`, for its longest time."""
        self._asked.append(kind)

    def calm(self) -> None:
        """No more random faults; those that are active end in their time."""
        self._per_second = 0.0

    def advance(self, now: float) -> list[tuple[FaultKind, bool]]:
        """What has begun (True) or ended (False) since the last call, in this order."""
        begun = [(kind, LONGEST[kind]) for kind in self._asked]
        self._asked.clear()
        begun += self._due(now)
        changes = []
        for kind, seconds in begun:
            self.counts[kind] += 1
            if kind not in self._ends:
                changes.append((kind, True))
            self._ends[kind] = max(self._ends.get(kind, now), now + seconds)
        for kind in [kind for kind, end in self._ends.items() if end <= now]:
            del self._ends[kind]
            changes.append((kind, False))
        return changes

    def _due(self, now: float) -> list[tuple[FaultKind, float]]:
        """Random faults whose time has come, with how long they last."""
        if self._per_second == 0.0:
            return []
        if self._next_at is None:
            self._next_at = now + self._random.expovariate(self._per_second)
        due = []
        while self._next_at <= now:
            (kind,) = self._random.choices(list(WEIGHTS), list(WEIGHTS.values()))
            due.append((kind, LONGEST[kind] * self._random.uniform(0.1, 1.0)))
            self._next_at += self._random.expovariate(self._per_second)
        return due
