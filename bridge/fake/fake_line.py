"""A pty that looks like a serial port, at a path of our own."""

import contextlib
import os
import pty
import tty
from pathlib import Path

from manipulator.errors import LinkError

MAX_READ = 4096


class FakeLine:
    """The board's end of a pty; `path` is a link to the other end, made here and removed again.

    Whatever else stands at `path` is left alone: only a dead link to a pty is replaced.
    """

    def __init__(self, path: Path) -> None:
        """LinkError when the path cannot be used."""
        self.path = path
        self._end, other_end = pty.openpty()
        tty.setraw(other_end)
        os.set_blocking(self._end, False)
        self._target = os.ttyname(other_end)
        # Kept open, so that reading never fails while no host has the port open.
        self._other_end = other_end
        try:
            self._make_link()
        except LinkError:
            self._close_ends()
            raise
        except OSError as error:
            self._close_ends()
            raise LinkError(f'{path} cannot be made: {error.strerror}') from error

    def another(self) -> 'FakeLine':
        """A new pty at the same path, once this one is closed."""
        return FakeLine(self.path)

    def fileno(self) -> int:
        """For select."""
        return self._end

    def read(self) -> bytes:
        """What the host has written since the last call."""
        try:
            return os.read(self._end, MAX_READ)
        except BlockingIOError:
            return b''

    def write(self, output: bytes) -> None:
        """To the host; what does not fit, because nobody reads, is lost as on a real line."""
        with contextlib.suppress(BlockingIOError):
            os.write(self._end, output)

    def close(self) -> None:
        """The port vanishes; the link goes too, if it is still ours."""
        with contextlib.suppress(OSError):
            if self.path.is_symlink() and str(self.path.readlink()) == self._target:
                self.path.unlink()
        self._close_ends()

    def _make_link(self) -> None:
        if self.path.is_symlink():
            old = str(self.path.readlink())
            if not old.startswith('/dev/pts/') or _is_alive(old, self._target):
                raise LinkError(f'{self.path} exists and leads to {old}: not overwritten')
            self.path.unlink()
        elif self.path.exists():
            raise LinkError(f'{self.path} exists and is no dead link of ours: not overwritten')
        self.path.symlink_to(self._target)

    def _close_ends(self) -> None:
        os.close(self._end)
        os.close(self._other_end)


def _is_alive(old: str, ours: str) -> bool:
    """Whether another pty stands where a link leads; our own new one may have its number."""
    return old != ours and Path(old).exists()
