"""Who jogs the machine: a person before the computer, among people the first to move.

A source owns the machine until it has been silent for RELEASE. A source that was rejected,
overridden or stopped must stay silent before it is accepted again: so nothing resumes by itself.
Times are monotonic receipt times in seconds.

Two pads on one topic defeat the deadman: one of them is seen released, the other one drives. A
message carries the number that its publisher gave it, and every publisher counts for itself. So of
two that publish at once a number comes that does not follow the last one, at the latest with the
third message. A publisher that is still known, but silent (one that was killed stays in the graph
for up to 20 s) does no harm, and does not count for long.
"""

from dataclasses import dataclass, field, replace
from typing import NoReturn

from manipulator.deadlines import RELEASE
from manipulator.errors import Refused

OVERLAP = 0.25
"""Seconds: messages of two publishers that come farther apart follow one another."""

QUIET = 1.0
"""Seconds without a sign of a second publisher after which there is one again."""

MOST_LOST = 5
"""Messages that may be lost in a row while a second publisher is known."""

NEVER = float('-inf')


@dataclass(frozen=True)
class SoleSource:
    """What is known after a message; times are monotonic receipt times in seconds.

    is_continuous: messages come whether the device is touched or not. Then every known
    publisher is expected to send: after a silence, and at the start, a second one counts as
    sending until it was silent for a while. Two that began together have numbers alike, and
    the first message of the one would be taken for the other one's.
    """

    is_continuous: bool = False
    sequence: int | None = None
    publishers: int = 0
    received_at: float = NEVER
    mixed: float = NEVER

    def receive(self, sequence: int | None, publishers: int, now: float) -> 'SoleSource':
        """After a message with its publisher's `sequence` number, while `publishers` are known.

        Without numbers from the middleware (None), a second known publisher counts as sending.
        """
        mixed = now if self._tells_of_two(sequence, publishers, now) else self.mixed
        return replace(
            self, sequence=sequence, publishers=publishers, received_at=now, mixed=mixed
        )

    def is_mixed(self, now: float) -> bool:
        """Whether two publishers were sending at once, a while ago at most."""
        return now - self.mixed < QUIET

    def _tells_of_two(self, sequence: int | None, publishers: int, now: float) -> bool:
        if sequence is None:
            return publishers > 1
        if self.sequence is None or now - self.received_at > OVERLAP:
            return self.is_continuous and publishers > 1
        step = sequence - self.sequence
        has_jumped = publishers > 1 and step > 1 + MOST_LOST
        return step <= 0 or has_jumped or publishers > self.publishers


COMPUTER = 'cmd_vel'
PEOPLE = ('cmd_vel/joy', 'cmd_vel/panel', 'cmd_vel/keyboard')
SOURCES = (COMPUTER, *PEOPLE)


@dataclass
class Arbiter:
    """Receives every source's messages and decides whose are accepted."""

    _received_at: dict[str, float] = field(default_factory=dict)
    _blocked: dict[str, str] = field(default_factory=dict)
    _owner: str = ''

    def receive(self, source: str, now: float, is_computer_busy: bool = False) -> None:
        """A message of `source` has come: it owns the machine now, or Refused names the owner.

        is_computer_busy: a goal, path or cycle is being driven.
        """
        if now - self._received_at.get(source, float('-inf')) > RELEASE:
            self._blocked.pop(source, None)
        owner = self.owner(now)
        self._received_at[source] = now
        if source in self._blocked:
            raise Refused(f'{self._blocked[source]}: release first')
        if owner and owner != source and not self._overrides(source, owner):
            self.reject(source, now, f'{owner} controls the machine')
        if source == COMPUTER and is_computer_busy and owner != source:
            self.reject(source, now, 'a goal is active')
        if owner and owner != source:
            self._blocked[owner] = f'{source} took over the machine'
        self._owner = source

    def owner(self, now: float) -> str:
        """The source that owns the machine, '' where none does."""
        if self._owner and now - self._received_at[self._owner] > RELEASE:
            self._owner = ''
        return self._owner

    def stop(self) -> None:
        """The owner is rejected until it releases."""
        if self._owner:
            self._blocked[self._owner] = 'the machine was stopped'
            self._owner = ''

    def reject(self, source: str, now: float, reason: str) -> NoReturn:
        """Raises Refused with the reason; the source owns nothing, and must release first."""
        self._received_at[source] = now
        self._blocked[source] = reason
        if self._owner == source:
            self._owner = ''
        raise Refused(f'{reason}: release first')

    @staticmethod
    def _overrides(source: str, owner: str) -> bool:
        return owner == COMPUTER and source in PEOPLE
