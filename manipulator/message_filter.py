"""The message filter of every subscription: rejects the stale, counts the refused.

Old and reordered messages are distinguished from fresh ones of a source with another clock: the
observed offset between the source's clock and ours is subtracted from stamps. Deadlines are kept
on receipt time alone.
"""

from collections.abc import Callable
from dataclasses import dataclass

from manipulator.deadlines import MESSAGE_AGE
from manipulator.errors import InvalidInput, ManipulatorError

NOTABLE_OFFSET = 0.5
"""Seconds by which a source's clock may be off before people should know."""


class StaleMessage(InvalidInput):
    """A message that is older than the last one, or than it may be."""


CONFIRMED_AFTER, AGREEMENT = 0.05, 0.1
"""Seconds between messages that indicate a clock that was set; how well their offsets agree."""


@dataclass
class StampFilter:
    """One source's clock, estimated from its messages; all times in seconds.

    The smallest (receipt − stamp) seen is the offset of a message without delay. Two refused
    messages that agree, 0.05 s apart or more, mean that the source's clock was set, or that
    another source took over: its offset is estimated again, and the second is admitted. Messages
    that queued while this process was frozen come all at once, and do not agree for so long.
    """

    maximum_age: float = MESSAGE_AGE
    offset: float | None = None
    _last_stamp: float = float('-inf')
    _refused: tuple[float, float] | None = None

    def admit(self, stamp: float, receipt: float) -> float:
        """How late it is, in seconds; StaleMessage when the message must not be acted on."""
        observed = receipt - stamp
        if self.offset is None or self._is_confirmed(observed, receipt):
            self.offset, self._last_stamp = observed, stamp
        self.offset = min(self.offset, observed)
        age, back = observed - self.offset, self._last_stamp - stamp
        if age > self.maximum_age:
            if not self._agrees(observed):
                self._refused = observed, receipt
            raise StaleMessage(
                f'{age:.3f} s old, at most {self.maximum_age:g} s: ignored, unless the next ones '
                'agree that the clock of the source was set'
            )
        if back > 0:
            raise StaleMessage(f'stamped {back:.3f} s before the last one: reordered, ignored')
        self._refused = None
        self._last_stamp = stamp
        return age

    def _is_confirmed(self, observed: float, receipt: float) -> bool:
        is_apart = self._refused is not None and receipt - self._refused[1] >= CONFIRMED_AFTER
        return is_apart and self._agrees(observed)

    def _agrees(self, observed: float) -> bool:
        """With the first of the messages that were refused in a row."""
        return self._refused is not None and abs(observed - self._refused[0]) < AGREEMENT


LONGEST_REASON = 400
"""Characters of a refusal that are logged and kept: the text of a message may be megabytes."""


class MessageFilter:
    """The messages of one topic: counts, the last refusal, the time of the last good one.

    Times are monotonic, in seconds; stamps are by the clock of their source. A message that is
    refused changes nothing else: the last good command stays. lateness: by how many seconds the
    message that is being accepted took longer than the fastest of its source.
    """

    def __init__(self, clock_start: float) -> None:
        """clock_start: the system's clock at monotonic time zero, for `clock_offset`."""
        self.refused = 0
        self.last_refusal = ''
        self.last_good = float('-inf')
        self.lateness = 0.0
        self._clock_start = clock_start
        self._stamps = StampFilter()

    def take(
        self, stamp: float, accept: Callable[[], object], now: float
    ) -> ManipulatorError | None:
        """Calls `accept` for a message that is fresh; returns why it was refused, None if not.

        A stamp of zero is taken as now. What `accept` raises as ManipulatorError is a refusal.
        """
        try:
            self.lateness = self._stamps.admit(stamp, now + self._clock_start) if stamp else 0.0
            accept()
        except ManipulatorError as error:
            self.refuse(error)
            return error
        self.last_good = now
        return None

    def refuse(self, error: ManipulatorError) -> None:
        """Notes that a message was not accepted, or not in the end."""
        self.refused += 1
        self.last_refusal = str(error)[:LONGEST_REASON]

    def age(self, now: float) -> float:
        """Seconds since the last good message, ∞ before the first."""
        return now - self.last_good

    @property
    def clock_offset(self) -> float:
        """By how much the clock of the source is ahead of ours, where that is notable; else 0."""
        offset = -(self._stamps.offset or 0.0)
        return offset if abs(offset) > NOTABLE_OFFSET else 0.0
