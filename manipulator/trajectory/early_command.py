"""A command that comes while the machine is about to be taken over waits for that, briefly.

A machine that was just enabled or cleared can be driven some ten milliseconds later: once its pose
is known and the board has followed a setpoint. Clients that see it enabled need not know.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from manipulator.errors import ManipulatorError, Refused
from manipulator.trajectory.supervisor import NotYet

PATIENCE = 1.0
"""Seconds from the first command that comes too early to its refusal, at most."""


@dataclass(frozen=True)
class _Early:
    """The command, the callback of its refusal, until when it waits (s), and for what."""

    act: Callable[[], object]
    refuse: Callable[[ManipulatorError], object]
    until: float
    missing: NotYet


class EarlyCommand:
    """The newest command that came too early; times are monotonic, in seconds."""

    def __init__(self) -> None:
        self._waiting: _Early | None = None

    def take(
        self,
        act: Callable[[], object],
        refuse: Callable[[ManipulatorError], object],
        now: float,
    ) -> None:
        """Acts, at once or at a later `poll`; takes the place of a command that waits.

        Where `act` raises NotYet it is tried again until PATIENCE has passed since the first that
        waited; what it raises then goes to `refuse`. What else it raises goes to the caller, and
        changes nothing: a bad command does not displace a good one.
        """
        until = now + PATIENCE if self._waiting is None else self._waiting.until
        try:
            act()
        except NotYet as missing:
            self._waiting = _Early(act, refuse, until, missing)
        else:
            self._waiting = None

    def poll(self, now: float) -> None:
        """Call at every tick, and when a machine state is received: a stop ends what waits."""
        early, self._waiting = self._waiting, None
        if early is None:
            return
        if now > early.until:
            early.refuse(early.missing)
            return
        try:
            early.act()
        except NotYet as missing:
            self._waiting = replace(early, missing=missing)
        except ManipulatorError as error:
            early.refuse(error)

    def drop(self, reason: str) -> None:
        """Refuses what waits."""
        early, self._waiting = self._waiting, None
        if early is not None:
            early.refuse(Refused(reason))
