"""Telling old and reordered messages from fresh ones whose source has another clock.

Deadlines are kept on receipt time alone. Stamps only serve to reject what overtook or queued up,
after the offset between the source's clock and ours, as observed, is taken out.
"""

from dataclasses import dataclass

from manipulator.errors import InvalidInput

NOTABLE_OFFSET = 0.5
"""Seconds by which a source's clock may be off before people should know."""


class StaleMessage(InvalidInput):
    """A message that is older than the last one, or than it may be."""


CONFIRMED_AFTER, AGREEMENT = 0.05, 0.1
"""Seconds between messages that tell of a clock that was set; how well their offsets agree."""


@dataclass
class StampGate:
    """One source's clock, learnt from its messages; all times in seconds.

    The smallest (receipt − stamp) seen is the offset of a message without delay. Two refused
    messages that agree, 0.05 s apart or more, mean that the source's clock was set, or that
    another source took over: its offset is learnt anew, and the second is admitted. What piled up
    while this process was frozen comes all at once, and does not agree for so long.
    """

    maximum_age: float = 0.5
    offset: float | None = None
    _last_stamp: float = float('-inf')
    _refused: tuple[float, float] | None = None

    def admit(self, stamp: float, receipt: float) -> None:
        """Raises StaleMessage when the message must not be acted on."""
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

    def _is_confirmed(self, observed: float, receipt: float) -> bool:
        is_apart = self._refused is not None and receipt - self._refused[1] >= CONFIRMED_AFTER
        return is_apart and self._agrees(observed)

    def _agrees(self, observed: float) -> bool:
        """With the first of the messages that were refused in a row."""
        return self._refused is not None and abs(observed - self._refused[0]) < AGREEMENT
