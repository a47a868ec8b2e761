"""A thread that computes what takes long, for the newest question only."""

import threading
import time
from collections.abc import Callable
from typing import Generic, TypeVar

Question = TypeVar('Question')


class NewestWorker(Generic[Question]):
    """Calls `work` with the newest question; those that were overtaken are never looked at."""

    def __init__(self, work: Callable[[Question], None]) -> None:
        self._work = work
        self._question: Question | None = None
        self._is_asked = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def ask(self, question: Question) -> None:
        """Returns at once."""
        self._question = question
        self._is_asked.set()

    def _run(self) -> None:
        while True:
            self._is_asked.wait()
            self._is_asked.clear()
            question, self._question = self._question, None
            if question is not None:
                begin = time.monotonic()
                self._work(question)
                time.sleep(time.monotonic() - begin)  # leaves half of the time to the rest
