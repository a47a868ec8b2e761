"""The thread that owns the serial port: it opens, reads, writes and waits, as the link says."""

import contextlib
import os
import select
import threading
import time
from collections.abc import Callable
from typing import Protocol

from bridge.link import Link
from manipulator.errors import LinkError


class Port(Protocol):
    """What the thread needs of an open serial port."""

    def fileno(self) -> int: ...  # noqa: D102
    def read(self) -> bytes: ...  # noqa: D102
    def write(self, waiting: bytes) -> bytes: ...  # noqa: D102
    def close(self) -> None: ...  # noqa: D102


class LinkThread(threading.Thread):
    """Gives a link its port, from `start` to `close`; what the link tells is told in this thread.

    A setpoint is written the moment it is there.
    """

    def __init__(self, open_port: Callable[[], Port], link: Link) -> None:
        super().__init__(name='link', daemon=True)
        self._open_port, self._link = open_port, link
        self._port: Port | None = None
        self._is_stopping = False
        self._wake_out, self._wake_in = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        link.wake = self._wake

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
                self._close_port()
                self._link.lost(str(error), time.monotonic())
        self._close_port()

    def _turn(self) -> None:
        """Waits for something to happen and does all there is to do."""
        if self._link.wants_port(time.monotonic()):
            self._port = self._open_port()
            self._link.opened(time.monotonic())
        received = self._wait()
        waiting = self._link.turn(received, time.monotonic())
        if waiting and self._port is not None:
            waiting = self._port.write(waiting)
        self._link.written(waiting, time.monotonic())

    def _wait(self) -> bytes:
        """What the port has to read, until the link's next turn is due."""
        now = time.monotonic()
        reading: list[int | Port] = [self._wake_out]
        writing: list[Port] = []
        if self._port is not None:
            reading += [self._port] if self._link.is_listening(now) else []
            writing += [self._port] if self._link.is_behind else []
        readable, _, _ = select.select(reading, writing, [], self._link.rest(now))
        if self._wake_out in readable:
            with contextlib.suppress(BlockingIOError):
                os.read(self._wake_out, 4096)
        return self._port.read() if self._port is not None and self._port in readable else b''

    def _close_port(self) -> None:
        if self._port is not None:
            self._port.close()
        self._port = None

    def _wake(self) -> None:
        if not self.is_alive():
            self._link.refuse_requests('the thread of the serial link does not run')
            return
        with contextlib.suppress(BlockingIOError):
            os.write(self._wake_in, b'w')
