"""One line of the table, and how times are taken."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Row:
    """A figure, what it should reach, and whether it does."""

    name: str
    value: str
    goal: str = ''
    reached: bool = True


def interleaved_medians(tasks: Sequence[Callable[[int], object]], rounds: int) -> list[float]:
    """Seconds of one call of each task, the medians over rounds in which all take their turn.

    Each task is told the round, so that it can take another input each time. Turns by turns,
    what else the computer does falls on all tasks alike; in another order each time, so does what
    the task before has left in the caches.
    """
    times, generator = np.empty((rounds, len(tasks))), np.random.default_rng(1)
    for k in range(rounds):
        for column in generator.permutation(len(tasks)).tolist():
            task = tasks[column]
            before = time.perf_counter()
            task(k)
            times[k, column] = time.perf_counter() - before
    return [float(t) for t in np.median(times, axis=0)]


def best_time(task: Callable[[], object], rounds: int = 7) -> float:
    """The least of a few, in seconds: what else the computer does only adds."""
    times = []
    for _ in range(rounds):
        before = time.perf_counter()
        task()
        times.append(time.perf_counter() - before)
    return min(times)
