"""The host's end of the serial line without I/O: what is sent, in which order, and the callbacks.

Commands go first, then the newest setpoint. The port is opened, read and written elsewhere.
"""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass

from bridge.events import Acknowledged, CommandFailed, Event, without_passed_states
from bridge.protocol import Command, Setpoint, Stop
from bridge.session import Session
from manipulator.errors import Refused

LOOK_AGAIN_AFTER = 0.25
"""Seconds from the loss of the port to the next attempt to open it."""

TICK = 0.05
"""Seconds between two turns at most."""

SPACING = 0.0025
"""Setpoints go out 400 times a second at most, half of what the line carries: a flood of them
must not queue up in the operating system, ahead of a STOP."""

MOST_AT_ONCE = 2048
"""Bytes: a longer read may have left some behind, which are then older than their receipt."""

FASTEST_LINE = 400_000.0
"""Bytes a second that a line of 4 Mbaud carries."""


@dataclass(frozen=True)
class Ticket:
    """A setpoint to be written to the port.

    received is monotonic, `stamped` the time on the sender's clock; both in seconds.
    """

    setpoint: Setpoint
    received: float
    stamped: float | None = None


@dataclass(frozen=True)
class _Outcome:
    """What happened, and the requests that it settles; `refusal` is why they are not obeyed."""

    event: Event | None
    futures: tuple['Future[None]', ...]
    refusal: Refused | None = None


class Link:
    """One session on a port that comes and goes; `now` is monotonic, in seconds.

    on_event receives all events in order, on_written each setpoint that was handed to the port;
    both in `written`, `opened` and `lost`: sending does not wait for callbacks.
    No more than bytes_per_second are to be read: a faster source is no serial line, and its
    noise must not take the processor from what stops the machine.

    It belongs to the thread that has the port, with its session.
    """

    def __init__(
        self,
        session: Session,
        on_event: Callable[[Event, float], None],
        on_written: Callable[[Ticket, float], None] = lambda ticket, now: None,
        bytes_per_second: float = FASTEST_LINE,
    ) -> None:
        self.session = session
        self.is_open = False
        self._on_event, self._on_written = on_event, on_written
        self._bytes_per_second = bytes_per_second
        self._look_at = self._read_at = self._setpoint_at = self._turned_at = 0.0
        self._emptied_at = 0.0
        self._unsent = b''
        self._mailbox: deque[Ticket] = deque(maxlen=1)
        self._requests: deque[tuple[Command, Future[None]]] = deque()
        self._waiting: list[tuple[Command, Future[None]]] = []
        self._sent_ticket: Ticket | None = None
        self._unreported: deque[_Outcome] = deque()

    def put_setpoint(self, ticket: Ticket) -> None:
        """Newest wins: one that was not yet sent is forgotten."""
        self._mailbox.append(ticket)

    def request(self, command: Command, answer: 'Future[None] | None' = None) -> 'Future[None]':
        """Done when the board has obeyed and on_event was called; Refused with the reason.

        It is always answered, by the next turn or when the session gives the command up: within
        a second, also a STOP that is not obeyed, which is still repeated.
        """
        future: Future[None] = answer or Future()
        if isinstance(command, Stop):
            self.session.is_stop_requested = True  # no setpoint goes out from here on
        self._requests.append((command, future))
        return future

    def wants_port(self, now: float) -> bool:
        """The port is to be opened now; a lost one is looked for every 0.25 s."""
        return not self.is_open and now >= self._look_at

    def is_listening(self, now: float) -> bool:
        """The port may be read: what came last was within bytes_per_second."""
        return self.is_open and now >= self._read_at

    @property
    def is_behind(self) -> bool:
        """The port has not yet taken all that was to be written."""
        return bool(self._unsent)

    def due_in(self, now: float) -> float:
        """Seconds until the next turn, where neither bytes nor `wake` call for one before."""
        if not self.is_open:
            return max(self._look_at - now, 0.0)
        due = [TICK]
        if self._mailbox and not self._unsent:
            due.append(max(self._setpoint_at - now, 0.0))
        if self._read_at > now:
            due.append(self._read_at - now)
        return min(due)

    def opened(self, now: float) -> None:
        """The port is open."""
        self.is_open = True
        self._turned_at = self._emptied_at = now
        self._note(self.session.opened(now))
        self._report(now)

    def lost(self, reason: str, now: float) -> None:
        """There is no port, or no more, and why."""
        self.is_open = False
        self._unsent, self._sent_ticket = b'', None
        self._look_at = now + LOOK_AGAIN_AFTER
        self._note(self.session.closed(reason, now))
        self._report(now)

    def turn(self, received: bytes, now: float) -> bytes:
        """All that is to be written now; `written` must follow."""
        self._take_requests(now)
        self._take_setpoint(now)
        self._unsent += self.session.take_output()
        if self.is_listening(now) and len(received) <= MOST_AT_ONCE:
            emptied_at, self._emptied_at = self._emptied_at, now
        else:
            emptied_at = self._emptied_at
        if received:
            self._read_at = now + len(received) / self._bytes_per_second
            self._note(without_passed_states(self.session.receive(received, now, emptied_at)))
        # After a stall the port is read before the board counts as silent.
        self._note(self.session.tick(self._turned_at))
        self._turned_at = now
        self._unsent += self.session.take_output()
        return self._unsent if self.is_open else b''

    def written(self, rest: bytes, now: float) -> None:
        """The port has taken all but the `rest`: calls back with the events of this turn."""
        self._unsent = rest
        ticket, self._sent_ticket = self._sent_ticket, None
        if ticket is not None:
            self._on_written(ticket, now)
        self._report(now)

    def _take_requests(self, now: float) -> None:
        while self._requests:
            command, future = self._requests.popleft()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                self._note(self.session.send_command(command, now))
                self._waiting.append((command, future))
            except Refused as error:
                self._unreported.append(_Outcome(None, (future,), error))

    def _take_setpoint(self, now: float) -> None:
        """Sends the newest setpoint, unless it waited longer than it is good for."""
        if self._unsent or not self._mailbox or now < self._setpoint_at:
            return
        ticket = self._mailbox.popleft()
        is_late = now - ticket.received > 1e-3 * ticket.setpoint.deadline_ms
        if is_late or not self.session.accepts_setpoints:
            return
        self._setpoint_at = now + SPACING
        self.session.send_setpoint(ticket.setpoint, now)
        self._sent_ticket = ticket

    def _note(self, events: list[Event]) -> None:
        """Queues events; the requests that they answer are found now, before new ones come."""
        for event in events:
            futures: tuple[Future[None], ...] = ()
            if isinstance(event, Acknowledged | CommandFailed):
                futures = tuple(f for command, f in self._waiting if command == event.command)
                self._waiting = [e for e in self._waiting if e[0] != event.command]
            refusal = Refused(event.reason) if isinstance(event, CommandFailed) else None
            self._unreported.append(_Outcome(event, futures, refusal))

    def _report(self, now: float) -> None:
        while self._unreported:
            outcome = self._unreported.popleft()
            if outcome.event is not None:
                self._on_event(outcome.event, now)  # first: a client may read the state at once
            for future in outcome.futures:
                if outcome.refusal is None:
                    future.set_result(None)
                else:
                    future.set_exception(outcome.refusal)
