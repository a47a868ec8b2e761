"""A terminal that hands over each key at once, and is restored in any case."""

import contextlib
import os
import select
import sys
import termios
import tty

from manipulator.errors import InvalidInput


class Terminal:
    """Standard input without lines and echo; a context manager. Ctrl-C still interrupts.

    Raises InvalidInput where standard input is no terminal.
    """

    def __init__(self) -> None:
        self._file = sys.stdin.fileno()
        if not os.isatty(self._file):
            raise InvalidInput('needs a terminal to read keys from, standard input is none')
        self._before = termios.tcgetattr(self._file)

    def __enter__(self) -> 'Terminal':
        """Keys come one by one; Ctrl-Z is a key, for a suspended process could not stop."""
        tty.setcbreak(self._file)
        mode = termios.tcgetattr(self._file)
        mode[6][termios.VSUSP] = b'\0'
        termios.tcsetattr(self._file, termios.TCSADRAIN, mode)
        return self

    def __exit__(self, *exception: object) -> None:
        """The terminal as it was."""
        self.restore()

    def restore(self) -> None:
        """Lines and echo as they were, where the terminal is still there."""
        with contextlib.suppress(termios.error):
            termios.tcsetattr(self._file, termios.TCSAFLUSH, self._before)

    def read(self) -> bytes | None:
        """What was typed since the last call; None once the terminal has gone."""
        if not select.select([self._file], [], [], 0)[0]:
            return b''
        try:
            return os.read(self._file, 4096) or None
        except OSError:
            return None

    def show(self, text: str) -> None:
        """Writes to standard output; a terminal that has gone is seen when reading."""
        with contextlib.suppress(OSError):
            os.write(sys.stdout.fileno(), text.encode())
