"""A path that is being worked out: its process, and the thread that waits for it."""

import os
import pickle
import subprocess
import sys
import threading

from manipulator.nodes.path_process import PathTask
from manipulator.pose import Pose
from manipulator.trajectory.path_timing import TimedPath

LONGEST = 60.0
"""Seconds after which a path is given up."""

PROGRAM = 'from manipulator.nodes.path_process import main; main()'


class PathWork:
    """Begins when made; `outcome` is None until it is over."""

    def __init__(self, task: PathTask) -> None:
        self.outcome: TimedPath | Pose | str | None = None
        search = os.pathsep.join(folder for folder in sys.path if folder)
        self._process = subprocess.Popen(
            [sys.executable, '-c', PROGRAM],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=os.environ | {'PYTHONPATH': search, 'OMP_NUM_THREADS': '1'},
        )
        self._thread = threading.Thread(target=self._wait, args=(task,), daemon=True)
        self._thread.start()

    def cancel(self) -> None:
        """Ends the process; nothing comes of it."""
        self._process.kill()

    def _wait(self, task: PathTask) -> None:
        try:
            answer, _ = self._process.communicate(task.pickled, timeout=LONGEST)
            self.outcome = pickle.loads(answer)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
            self.outcome = f'not worked out within {LONGEST:g} s'
        except (EOFError, OSError, pickle.UnpicklingError):
            self.outcome = 'the process that worked it out has died'
