"""The way of a program through time: a cycle, or a table. Pulse counts by channel, seconds."""

import math
from collections.abc import Callable, Sequence
from typing import Protocol, TypeAlias

from bridge.protocol import CycleAxis

PERIOD = 0.02
LONGEST = 60.0

Counts: TypeAlias = tuple[float, ...]
Solver: TypeAlias = Callable[[Sequence[float]], Counts | None]
"""Counts for x, y, z, roll, pitch and yaw from home; None where that is out of reach."""


class Course(Protocol):
    """A program's way through time."""

    duration: float

    def start(self) -> Counts | None: ...  # noqa: D102
    def at(self, time: float, part: float) -> Counts | None: ...  # noqa: D102


class Cycle:
    """One sine on each axis about home; its amplitudes are multiplied by `part`."""

    def __init__(self, axes: Sequence[CycleAxis], solve: Solver) -> None:
        self._axes, self._solve = axes, solve
        frequencies = [a.frequency_mhz for a in axes if a.amplitude and a.frequency_mhz]
        slowest = math.gcd(*frequencies)
        self.duration = 1000 / slowest if frequencies and slowest * LONGEST >= 1000 else 0.0

    def start(self) -> Counts | None:
        """Home."""
        return self.at(0.0, 0.0)

    def at(self, time: float, part: float) -> Counts | None:
        """None where a leg does not close or a limit is passed."""
        angles = (2e-3 * math.pi * a.frequency_mhz * time + a.phase for a in self._axes)
        return self._solve(
            [part * a.amplitude * math.sin(t) for a, t in zip(self._axes, angles, strict=True)]
        )


class Table:
    """Rows of counts at equal time steps; straight lines between them."""

    def __init__(self, rows: Sequence[tuple[int, ...]], step_ms: int, is_loop: bool) -> None:
        self._rows = [*rows, rows[0]] if is_loop else list(rows)
        self._step = 1e-3 * step_ms
        self.duration = self._step * (len(self._rows) - 1)

    def start(self) -> Counts:
        """The first row."""
        return self._rows[0]

    def at(self, time: float, part: float) -> Counts:
        """The time alone decides; `part` is a cycle's."""
        row = min(int(time / self._step), len(self._rows) - 1)
        after = min(row + 1, len(self._rows) - 1)
        share = time / self._step - row
        pairs = zip(self._rows[row], self._rows[after], strict=True)
        return tuple(a + share * (b - a) for a, b in pairs)

    def is_slow_enough(self, steps: Sequence[float]) -> bool:
        """No servo is faster than it can be; `steps` is what each moves in one period."""
        periods = self._step / PERIOD
        pairs = zip(self._rows, self._rows[1:], strict=False)
        return all(is_within(a, b, [s * periods for s in steps]) for a, b in pairs)


def is_within(before: Counts, after: Counts, steps: Sequence[float]) -> bool:
    """Each count within its step of the one before."""
    triples = zip(before, after, steps, strict=True)
    return all(abs(b - a) <= step for a, b, step in triples)
