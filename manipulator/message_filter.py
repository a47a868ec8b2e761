"""What every subscription does with a message: reject the stale, count the bad, note the good."""

from collections.abc import Callable

from manipulator.errors import ManipulatorError
from manipulator.stamps import NOTABLE_OFFSET, StampGate

LONGEST_REASON = 400
"""Characters of a refusal that are logged and kept: a message's own words may be megabytes."""


class MessageFilter:
    """The messages of one topic: counts, the last refusal, the time of the last good one.

    Times are monotonic, in seconds; stamps are by the clock of their source. A message that is
    refused changes nothing else: the last good command stays.
    """

    def __init__(self, clock_start: float) -> None:
        """clock_start: the system's clock at monotonic time zero, for `clock_offset`."""
        self.refused = 0
        self.last_refusal = ''
        self.last_good = float('-inf')
        self._clock_start = clock_start
        self._gate = StampGate()

    def take(
        self, stamp: float, accept: Callable[[], object], now: float
    ) -> ManipulatorError | None:
        """Calls `accept` for a message that is fresh; returns why it was refused, None if not.

        A stamp of zero is taken as now. What `accept` raises as ManipulatorError is a refusal.
        """
        try:
            if stamp:
                self._gate.admit(stamp, now + self._clock_start)
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
        offset = -(self._gate.offset or 0.0)
        return offset if abs(offset) > NOTABLE_OFFSET else 0.0
