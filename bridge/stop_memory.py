"""A STOP outlives the bridge: a file says that one was asked for and has not been cleared.

The board latches a STOP that it heard, but one that is asked for while the board is away is known
to the bridge alone, and a board that starts again has forgotten.
"""

import os
import re
import tempfile
import threading
import time
from collections.abc import Mapping
from pathlib import Path

LONGEST_NAME = 200
RETRY_AFTER = 2.0
"""Seconds until a write that failed is tried again."""


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


class StopMemory:
    """Remembers in `path` whether a STOP stands; from any thread."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = threading.Lock()
        # What may not even be looked at was not written by us.
        self._is_kept = self._written = os.access(path, os.F_OK)
        self._retry_at = float('-inf')

    @property
    def is_kept(self) -> bool:
        """A STOP stands that nobody has cleared."""
        return self._is_kept

    def keep(self, is_stop_wanted: bool) -> str:
        """Writes it down where it has changed; why that failed, or ''."""
        with self._lock:
            self._is_kept = is_stop_wanted
            if is_stop_wanted == self._written or time.monotonic() < self._retry_at:
                return ''
            try:
                self._write(is_stop_wanted)
                self._written = is_stop_wanted
            except OSError as error:
                self._retry_at = time.monotonic() + RETRY_AFTER
                return f'{self.path}: {error.strerror}: a restart forgets this STOP or CLEAR'
            return ''

    def _write(self, is_stop_wanted: bool) -> None:
        if is_stop_wanted:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self.path.touch()
        else:
            self.path.unlink(missing_ok=True)
