"""The serial port, and the thread that owns it and the link: it opens, reads, writes and waits."""

import contextlib
import errno
import os
import select
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Protocol

import serial

from bridge.link import Link
from bridge.protocol import Command
from manipulator.errors import LinkError

_REASONS = {
    errno.ENOENT: 'does not exist: is the board plugged in?',
    errno.ENXIO: 'does not exist: is the board plugged in?',
    errno.ENODEV: 'does not exist: is the board plugged in?',
    errno.EIO: 'has no board behind it any more',
    errno.EACCES: 'is not permitted: add yourself to the group dialout '
    "('sudo usermod -aG dialout $USER', then log in again)",
    errno.EPERM: 'is not permitted: is another program using it exclusively?',
    errno.EBUSY: 'is in use by another program',
    errno.EAGAIN: 'is in use by another program (a second serial_bridge?)',
    errno.ENOTTY: 'is not a serial port',
    errno.EINVAL: 'is not a serial port, or cannot run at this baud rate',
    errno.EISDIR: 'is a folder, not a serial port',
    errno.ELOOP: 'is a link that leads to itself',
}
MAX_READ = 4096


class SerialPort:
    """An open port that never blocks. Opening it resets an Arduino: it boots for 1 to 2 s."""

    def __init__(self, name: str, baud: int) -> None:
        """LinkError with the reason why the port cannot be opened."""
        self.name = name
        try:
            self._port = serial.Serial(name, baud, timeout=0, exclusive=True)
        except (serial.SerialException, OSError, ValueError) as error:
            raise LinkError(f'{name} {_reason(error)}') from error
        # Only some adapters know it (FTDI: 1 ms instead of 16); all others do without.
        with contextlib.suppress(OSError, ValueError, NotImplementedError, AttributeError):
            self._port.set_low_latency_mode(True)

    def fileno(self) -> int:
        """For select."""
        return int(self._port.fileno())

    def read(self) -> bytes:
        """The received bytes, once the port is readable; LinkError: it was the end."""
        try:
            received = os.read(self.fileno(), MAX_READ)
        except BlockingIOError:
            return b''
        except OSError as error:
            raise LinkError(f'{self.name} was disconnected ({_reason(error)})') from error
        if not received:
            raise LinkError(f'{self.name} {self._why_nothing()}')
        return received

    def _why_nothing(self) -> str:
        """Why a port that was readable held nothing: its end, or another reader was quicker."""
        poll = select.poll()
        poll.register(self.fileno(), 0)  # POLLHUP and POLLERR are reported in any case
        if poll.poll(0):
            return 'was disconnected (unplugged?)'
        return 'is read by another program as well, which takes bytes away: end that one'

    def write(self, waiting: bytes) -> bytes:
        """Writes what fits and returns the rest; LinkError when the port was disconnected."""
        try:
            return waiting[os.write(self.fileno(), waiting) :]
        except BlockingIOError:
            return waiting
        except OSError as error:
            raise LinkError(f'{self.name} was disconnected ({_reason(error)})') from error

    def close(self) -> None:
        """Gives the port back; what is still in its buffers is lost."""
        with contextlib.suppress(OSError):
            self._port.close()


def _reason(error: Exception) -> str:
    """What the error number means; pyserial drops the one of termios, which is the cause."""
    behind = error.__context__
    number = getattr(error, 'errno', None) or (behind.args[0] if behind and behind.args else None)
    return _REASONS.get(number or 0) or f'cannot be used: {error}'


class Port(Protocol):
    """What the thread needs of an open serial port."""

    def fileno(self) -> int: ...  # noqa: D102
    def read(self) -> bytes: ...  # noqa: D102
    def write(self, waiting: bytes) -> bytes: ...  # noqa: D102
    def close(self) -> None: ...  # noqa: D102


class Input(Protocol):
    """What else the thread waits for; `receive` is called in it."""

    def fileno(self) -> int: ...  # noqa: D102
    def receive(self) -> None: ...  # noqa: D102


class LinkThread(threading.Thread):
    """Gives a link its port, from `start` to `close`; the link's callbacks run in this thread.

    No other thread touches the link or what belongs to it: others `post` calls to this one.
    """

    def __init__(
        self, open_port: Callable[[], Port], link: Link, inputs: Sequence[Input] = ()
    ) -> None:
        super().__init__(name='link', daemon=True)
        self._open_port, self._link, self._inputs = open_port, link, inputs
        self._port: Port | None = None
        self._posted: deque[Callable[[], object]] = deque()
        self._is_stopping = False
        self._wake_out, self._wake_in = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)

    def post(self, act: Callable[[], object]) -> None:
        """Has it done in this thread, in the order of the calls; from any thread."""
        self._posted.append(act)
        self._wake()

    def request(self, command: Command) -> 'Future[None]':
        """As `Link.request`; from any thread."""
        answer: Future[None] = Future()
        self.post(lambda: self._link.request(command, answer))
        return answer

    def close(self) -> None:
        """Ends the thread and gives the port back; nothing may be posted any more."""
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
        for _ in range(len(self._posted)):
            self._posted.popleft()()
        waiting = self._link.turn(received, time.monotonic())
        if waiting and self._port is not None:
            waiting = self._port.write(waiting)
        self._link.written(waiting, time.monotonic())

    def _wait(self) -> bytes:
        """What the port has to read, until the link's next turn is due."""
        now = time.monotonic()
        reading: list[int | Input | Port] = [self._wake_out, *self._inputs]
        writing: list[Port] = []
        if self._port is not None:
            reading += [self._port] if self._link.is_listening(now) else []
            writing += [self._port] if self._link.is_behind else []
        readable, _, _ = select.select(reading, writing, [], self._link.due_in(now))
        if self._wake_out in readable:
            with contextlib.suppress(BlockingIOError):
                os.read(self._wake_out, 4096)
        for waiting in self._inputs:
            if waiting in readable:
                waiting.receive()
        return self._port.read() if self._port is not None and self._port in readable else b''

    def _close_port(self) -> None:
        if self._port is not None:
            self._port.close()
        self._port = None

    def _wake(self) -> None:
        with contextlib.suppress(BlockingIOError):
            os.write(self._wake_in, b'w')
