"""Who holds the joystick of the pages, and whether a hand is still on it.

Every open page shows the joystick; the first page to press it owns it until release. A press
lives on its beats alone: a release, a page that is gone, frozen or late ends it, and an ended
press never comes to life again, whatever beats still arrive; only a new press does.

Each beat is answered with a tick, the time of the answer, and the page puts the newest tick that
it has seen into its next beat: so a beat shows how long ago page and line were both alive.
Nothing moves before the first tick came back. Times are monotonic, in seconds.
"""

from dataclasses import dataclass, field

from manipulator.arrays import Array
from manipulator.deadlines import RELEASE

ANOTHER = 'another page has the joystick'
LAPSED = 'no heartbeat came from the page: press again'
STALE = 'the page or the line is slow: press again'
STOPPED = 'the machine was stopped: press again'


@dataclass(frozen=True, eq=False)
class Beat:
    """A page's heartbeat: press number `press` is still held, the stick (6,) in −1 to 1.

    tick is the newest that the page has seen during this press, None before the first.
    """

    press: int
    tick: float | None
    stick: Array


@dataclass(eq=False)
class _Hold:
    """The press that has the joystick: its last beat, and the stick once a tick came back."""

    page: int
    press: int
    received_at: float
    stick: Array | None = None


@dataclass(eq=False)
class Joystick:
    """The one joystick of all pages."""

    _hold: _Hold | None = None
    _over: dict[int, int] = field(default_factory=dict)
    _reasons: dict[int, str] = field(default_factory=dict)

    def receive(self, page: int, beat: Beat, now: float) -> None:
        """A beat of one page has come."""
        self._expire(now)
        if beat.press <= self._over.get(page, -1):
            return
        if self._hold is not None and self._hold.page != page:
            self._end(page, beat.press, ANOTHER)
        elif beat.tick is not None and not 0.0 <= now - beat.tick <= RELEASE:
            self._end(page, beat.press, STALE)
        elif self._hold is not None and self._hold.press == beat.press:
            self._hold.received_at = now
            self._hold.stick = None if beat.tick is None else beat.stick
        elif beat.tick is None:
            self._reasons.pop(page, None)
            self._hold = _Hold(page, beat.press, now)
        else:
            self._end(page, beat.press, LAPSED)

    def release(self, page: int, press: int) -> None:
        """The page has released this press, and every one before it."""
        self._end(page, press, '')

    def leave(self, page: int) -> None:
        """The page is gone."""
        self._over.pop(page, None)
        self._reasons.pop(page, None)
        if self._hold is not None and self._hold.page == page:
            self._hold = None

    def stop(self) -> None:
        """Takes the joystick from its owner; only a new press moves again."""
        if self._hold is not None:
            self._end(self._hold.page, self._hold.press, STOPPED)

    def holder(self, now: float) -> int | None:
        """The page that has the joystick."""
        self._expire(now)
        return None if self._hold is None else self._hold.page

    def stick(self, now: float) -> Array | None:
        """What is held (6,), None while nothing is."""
        self._expire(now)
        return None if self._hold is None else self._hold.stick

    def reason(self, page: int) -> str:
        """Why the page's last press was ended, '' where it was not."""
        return self._reasons.get(page, '')

    def _expire(self, now: float) -> None:
        if self._hold is not None and now - self._hold.received_at > RELEASE:
            self._end(self._hold.page, self._hold.press, LAPSED)

    def _end(self, page: int, press: int, reason: str) -> None:
        self._over[page] = max(press, self._over.get(page, -1))
        self._reasons[page] = reason
        if self._hold is not None and self._hold.page == page:
            self._hold = None
