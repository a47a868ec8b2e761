"""A STOP outlives the bridge: a file says that one was asked for and has not been cleared.

The board latches a STOP that it heard, but one that is asked for while the board is away is known
to the bridge alone, and a board that starts again has forgotten.
"""

import os
import re
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path

LONGEST_NAME = 200
RETRY_AFTER = 2.0
"""Seconds until a write that failed is tried again."""

CLOSES_WITHIN = 1.0
"""Seconds that a slow disk may hold up the end of the bridge."""


def stop_file(bridge: str, port: str, environment: Mapping[str, str] = os.environ) -> Path:
    """Where the bridge of this full name keeps it for this port: XDG_STATE_HOME/hexarm.

    A port outside /dev is a fake board's, and what is remembered of it stands beside it.
    """
    if not Path(port).is_relative_to('/dev'):
        return Path(f'{port}.stop')
    home = environment.get('HOME') or tempfile.gettempdir()
    state = environment.get('XDG_STATE_HOME') or Path(home, '.local', 'state')
    name = re.sub(r'[^\w.-]+', '_', f'stop{bridge}{port}')
    return Path(state) / 'hexarm' / name[-LONGEST_NAME:]


class StopMemory(threading.Thread):
    """Remembers in `path` whether a STOP stands.

    `keep` may be called from any thread and waits for nothing: the file is written in this one, a
    disk can take seconds. on_trouble hears why a write failed; it is tried again every 2 s.
    """

    def __init__(
        self, path: Path, on_trouble: Callable[[str], object] = lambda reason: None
    ) -> None:
        super().__init__(name='stop memory', daemon=True)
        self.path = path
        self._on_trouble = on_trouble
        self._lock = threading.Lock()
        # What may not even be looked at was not written by us.
        self._is_kept = self._written = os.access(path, os.F_OK)
        self._has_news = threading.Event()
        self._is_closing = False
        self._trouble = ''

    @property
    def is_kept(self) -> bool:
        """A STOP stands that nobody has cleared."""
        return self._is_kept

    def keep(self, is_stop_wanted: Callable[[], bool]) -> None:
        """From now on this is what the next bridge is told.

        Asked under a lock: else a thread that asked before a STOP could say so after it.
        """
        with self._lock:
            before, self._is_kept = self._is_kept, is_stop_wanted()
            if self._is_kept != before:
                self._has_news.set()

    def run(self) -> None:
        """The thread's work, until `close`."""
        while not self._is_closing:
            is_behind = self._is_kept != self._written
            self._has_news.wait(RETRY_AFTER if is_behind else None)
            self._has_news.clear()
            self._write(self._is_kept)

    def close(self) -> None:
        """Ends the thread when the last word is written, or when that takes too long."""
        self._is_closing = True
        self._has_news.set()
        self.join(CLOSES_WITHIN)

    def _write(self, is_stop_wanted: bool) -> None:
        if is_stop_wanted == self._written:
            return
        try:
            if is_stop_wanted:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                self.path.touch()
            else:
                self.path.unlink(missing_ok=True)
        except OSError as error:
            self._complain(f'{self.path}: {error.strerror}: a restart forgets this STOP or CLEAR')
        else:
            self._written = is_stop_wanted
            self._trouble = ''

    def _complain(self, trouble: str) -> None:
        if trouble != self._trouble:
            self._trouble = trouble
            self._on_trouble(trouble)
