"""Who jogs the machine: a person before the computer, among people whoever moves first.

A source owns the machine until it has been silent for SILENCE. A source that was turned away,
overridden or stopped must fall silent before it is heard again: so nothing resumes by itself.
Times are monotonic receipt times in seconds.
"""

from dataclasses import dataclass, field
from typing import NoReturn

from manipulator.errors import Refused

SILENCE = 0.25
"""Seconds without a message after which a source has let go."""

COMPUTER = 'cmd_vel'
PEOPLE = ('cmd_vel/joy', 'cmd_vel/panel', 'cmd_vel/keyboard')
SOURCES = (COMPUTER, *PEOPLE)


@dataclass
class Arbiter:
    """Hears every source's messages and says whose count."""

    _heard_at: dict[str, float] = field(default_factory=dict)
    _blocked: dict[str, str] = field(default_factory=dict)
    _owner: str = ''

    def hear(self, source: str, now: float, is_computer_busy: bool = False) -> None:
        """A message of `source` has come: it owns the machine now, or Refused says who does.

        is_computer_busy: a goal, path or cycle is being driven.
        """
        if now - self._heard_at.get(source, float('-inf')) > SILENCE:
            self._blocked.pop(source, None)
        owner = self.owner(now)
        self._heard_at[source] = now
        if source in self._blocked:
            raise Refused(f'{self._blocked[source]}: let go first')
        if owner and owner != source and not self._overrides(source, owner):
            self.turn_away(source, now, f'{owner} has the machine')
        if source == COMPUTER and is_computer_busy and owner != source:
            self.turn_away(source, now, 'a goal is being driven')
        if owner and owner != source:
            self._blocked[owner] = f'{source} took the machine over'
        self._owner = source

    def owner(self, now: float) -> str:
        """The source that has the machine, '' where nobody has."""
        if self._owner and now - self._heard_at[self._owner] > SILENCE:
            self._owner = ''
        return self._owner

    def stop(self) -> None:
        """The owner is not heard until he has let go."""
        if self._owner:
            self._blocked[self._owner] = 'the machine was stopped'
            self._owner = ''

    def turn_away(self, source: str, now: float, reason: str) -> NoReturn:
        """Raises Refused with the reason; the source has nothing, and must let go first."""
        self._heard_at[source] = now
        self._blocked[source] = reason
        if self._owner == source:
            self._owner = ''
        raise Refused(f'{reason}: let go first')

    @staticmethod
    def _overrides(source: str, owner: str) -> bool:
        return owner == COMPUTER and source in PEOPLE
