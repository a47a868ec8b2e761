"""The node's end of the process that hears paths: starts it, takes what it hears."""

import os
import pickle
import subprocess
import sys
import threading

from manipulator.nodes.path_listener import HeardPath

PROGRAM = 'from manipulator.nodes.path_listener import main; main()'
PAUSE = 1.0
"""Seconds before a process that has died is started again."""


class PathEar:
    """Keeps the newest path heard until it is taken."""

    def __init__(self, namespace: str, topic: str) -> None:
        self._arguments = [sys.executable, '-c', PROGRAM, namespace, topic]
        self._newest: HeardPath | None = None
        self._closed = threading.Event()
        self._process = self._started()
        threading.Thread(target=self._listen, daemon=True).start()

    def take(self) -> HeardPath | None:
        """The newest path since the last call, None where there is none."""
        taken, self._newest = self._newest, None
        return taken

    def close(self) -> None:
        """Ends the process."""
        self._closed.set()
        self._process.kill()
        self._process.wait()

    def _started(self) -> 'subprocess.Popen[bytes]':
        search = os.pathsep.join(folder for folder in sys.path if folder)
        return subprocess.Popen(
            self._arguments,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=os.environ | {'PYTHONPATH': search},
        )

    def _listen(self) -> None:
        while not self._closed.is_set():
            try:
                self._newest = pickle.load(self._process.stdout)  # type: ignore[arg-type]
            except (EOFError, OSError, pickle.UnpicklingError):
                self._process.kill()
                self._process.wait()
                if not self._closed.wait(PAUSE):
                    self._process = self._started()
