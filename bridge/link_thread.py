"""The thread that owns the serial port: it writes a setpoint the moment it is there.

Everything else asks it for something and is told what happened, through events.
"""

import contextlib
import os
import select
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Protocol

from bridge.events import Acknowledged, CommandFailed, Event, without_passed_states
from bridge.messages import Command, Setpoint, Stop
from bridge.session import Session
from manipulator.errors import LinkError, Refused

LOOK_AGAIN_AFTER = 0.25
TICK = 0.05
SPACING = 0.0025
"""Setpoints go out 400 times a second at most, half of what the line carries: a flood of them
must not queue up in the operating system, ahead of a STOP."""


FASTEST_LINE = 400_000.0
"""Bytes a second that a line of 4 Mbaud carries."""


class Port(Protocol):
    """What the thread needs of an open serial port."""

    def fileno(self) -> int: ...  # noqa: D102
    def read(self) -> bytes: ...  # noqa: D102
    def write(self, waiting: bytes) -> bytes: ...  # noqa: D102
    def close(self) -> None: ...  # noqa: D102


@dataclass(frozen=True)
class Ticket:
    """A setpoint on its way to the port.

    received is monotonic, `stamped` the time on the sender's clock; both in seconds.
    """

    setpoint: Setpoint
    received: float
    stamped: float | None = None


class LinkThread(threading.Thread):
    """Reads, writes, looks for a lost port every 0.25 s. Callbacks run in this thread.

    on_event hears all events in order; on_written hears each setpoint that was handed to the
    port, with the monotonic time of it. No more than bytes_per_second are read: what sends more is
    no serial line, and its noise must not take the processor from what stops the machine.
    """

    def __init__(
        self,
        open_port: Callable[[], Port],
        session: Session,
        on_event: Callable[[Event], None],
        on_written: Callable[[Ticket, float], None] = lambda ticket, now: None,
        bytes_per_second: float = FASTEST_LINE,
    ) -> None:
        super().__init__(name='link', daemon=True)
        self.session = session
        self._open_port = open_port
        self._on_event = on_event
        self._on_written = on_written
        self._port: Port | None = None
        self._bytes_per_second = bytes_per_second
        self._look_at = self._read_at = 0.0
        self._setpoint_at = 0.0
        self._unsent = b''
        self._mailbox: deque[Ticket] = deque(maxlen=1)
        self._requests: deque[tuple[Command, Future[None]]] = deque()
        self._waiting: list[tuple[Command, Future[None]]] = []
        self._is_stopping = False
        self._wake_out, self._wake_in = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)

    def put_setpoint(self, ticket: Ticket) -> None:
        """Newest wins: one that was not yet written is forgotten."""
        self._mailbox.append(ticket)
        self._wake()

    def request(self, command: Command) -> 'Future[None]':
        """Done when the board has obeyed and on_event has heard it; Refused says why not."""
        future: Future[None] = Future()
        if isinstance(command, Stop):
            self.session.is_stop_wanted = True  # no setpoint goes out from here on
        if not self.is_alive():
            future.set_exception(Refused('the thread of the serial link does not run'))
            return future
        self._requests.append((command, future))
        self._wake()
        return future

    def close(self) -> None:
        """Ends the thread and gives the port back."""
        self._is_stopping = True
        self._wake()
        self.join()
        os.close(self._wake_in)
        os.close(self._wake_out)

    def run(self) -> None:
        """The thread's work, until `close`."""
        while not self._is_stopping:
            try:
                self._turn()
            except LinkError as error:
                self._lose_port(str(error))
        if self._port is not None:
            self._port.close()

    def _turn(self) -> None:
        """Waits for something to happen and does all there is to do."""
        now = time.monotonic()
        if self._port is None and now >= self._look_at:
            self._look_at = now + LOOK_AGAIN_AFTER
            self._port = self._open_port()
            self._tell(self.session.opened(now))
        looked_at = time.monotonic()
        has_input = self._wait()
        self._take_requests()
        self._take_setpoint()
        self._write()
        if self._port is not None and has_input:
            received, now = self._port.read(), time.monotonic()
            self._read_at = now + len(received) / self._bytes_per_second
            self._tell(without_passed_states(self.session.receive(received, now)))
        # A thread that was held up may not call the board silent before it has listened again.
        self._tell(self.session.tick(looked_at))
        self._write()

    def _wait(self) -> bool:
        """Whether the port has something to read."""
        reading: list[int | Port] = [self._wake_out]
        writing: list[Port] = []
        timeout = TICK
        if self._port is None:
            timeout = max(self._look_at - time.monotonic(), 0.0)
        else:
            if self._mailbox and not self._unsent:
                timeout = min(max(self._setpoint_at - time.monotonic(), 0.0), TICK)
            pause = self._read_at - time.monotonic()
            if pause > 0.0:
                timeout = min(timeout, pause)
            else:
                reading.append(self._port)
            writing += [self._port] if self._unsent else []
        readable, _, _ = select.select(reading, writing, [], timeout)
        if self._wake_out in readable:
            with contextlib.suppress(BlockingIOError):
                os.read(self._wake_out, 4096)
        return self._port in readable

    def _take_requests(self) -> None:
        while self._requests:
            command, future = self._requests.popleft()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                events = self.session.send_command(command, time.monotonic())
            except Refused as error:
                future.set_exception(error)
                continue
            try:
                self._write()  # the frame first; what it displaced is told afterwards
            finally:
                self._tell(events)
                self._waiting.append((command, future))

    def _take_setpoint(self) -> None:
        """Hands over the newest setpoint, unless it waited longer than it is good for."""
        now = time.monotonic()
        if self._unsent or not self._mailbox or now < self._setpoint_at:
            return
        ticket = self._mailbox.popleft()
        is_late = now - ticket.received > 1e-3 * ticket.setpoint.deadline_ms
        if is_late or not self.session.accepts_setpoints:
            return
        self._setpoint_at = now + SPACING
        self.session.send_setpoint(ticket.setpoint, now)
        self._write()
        self._on_written(ticket, time.monotonic())

    def _write(self) -> None:
        self._unsent += self.session.take_output()
        if self._unsent and self._port is not None:
            self._unsent = self._port.write(self._unsent)

    def _lose_port(self, reason: str) -> None:
        if self._port is not None:
            self._port.close()
        self._port = None
        self._unsent = b''
        self._look_at = max(self._look_at, time.monotonic() + LOOK_AGAIN_AFTER)
        self._tell(self.session.closed(reason, time.monotonic()))

    def _tell(self, events: list[Event]) -> None:
        for event in events:
            self._on_event(event)  # first: who is answered may look at once
            if isinstance(event, Acknowledged | CommandFailed):
                self._settle(event)

    def _settle(self, event: Acknowledged | CommandFailed) -> None:
        settled = [future for command, future in self._waiting if command == event.command]
        self._waiting = [entry for entry in self._waiting if entry[0] != event.command]
        for future in settled:
            if isinstance(event, Acknowledged):
                future.set_result(None)
            else:
                future.set_exception(Refused(event.reason))

    def _wake(self) -> None:
        with contextlib.suppress(BlockingIOError):
            os.write(self._wake_in, b'w')
