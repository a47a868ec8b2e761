"""Streams of goals: followed with their own velocity, so that a smooth stream stays smooth.

A move to a goal ends at rest. Made anew for each goal of a stream, as quickly as limits allow, it
speeds up and brakes each time. Here the goals show how they move, and each is reached moving like
that, a little later than it came: docs/motion.md, section 6.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Generic, TypeVar

import numpy as np

from manipulator.arrays import Array
from manipulator.planning.flowing import SHORTEST
from manipulator.planning.goal import Flow, Goal

Place = TypeVar('Place')
"""Of a goal: its pose, or its joints (n,)."""

Difference = Callable[[Place, Place], Array]
"""From one to another: a twist (6,), or the difference of joints (n,)."""

LONGEST_GAP = 0.12
"""Seconds between two goals of a stream, by their stamps, or as they come where they have none."""

GAPS = 2.5
"""How many gaps later than it comes a goal is reached, at least SHORTEST."""

SLACK = 0.02
"""Seconds by which a goal may be late, and what a tick adds."""

DRIFT = 0.03
"""The part of the difference of clocks, and of delays, that each goal corrects."""

LEAST_GAIN = 0.05
"""Of what a message is late, that corrects the clock of an even stream in the long run."""

LATE, MOST_LOST = 0.35, 3
"""Periods that a message may be late after others were lost, and how many in a row may be."""

FORGET, CLEARLY = 0.9, 0.5
"""What is kept of the roughness of a stream with each goal; and how much of the roughness with its
stamps is clearly less."""


class Clock:
    """When messages were sent, if they are sent evenly: a line through inexact times."""

    def __init__(self) -> None:
        self._count = 0
        self._time = self._period = 0.0

    def sent(self, noted: float) -> float:
        """For a message of that time; the first one of another period begins anew."""
        steps = self._steps(noted)
        late = noted - (self._time + steps * self._period)
        most = 0.5 if steps == 1 else LATE
        if self._count > 1 and (abs(late) > most * self._period or steps > 1 + MOST_LOST):
            self._count = 0
        k = self._count = self._count + 1
        if k == 1:
            self._time, self._period = noted, 0.0
            return noted
        self._time += steps * self._period + max((4 * k - 2) / (k * (k + 1)), LEAST_GAIN) * late
        self._period += max(6 / (k * (k + 1)), LEAST_GAIN**2) * late / steps
        return self._time

    def _steps(self, noted: float) -> int:
        """Periods since the last message: more than one where others were lost."""
        is_known = self._count > 2 and self._period > 0.0
        return max(round((noted - self._time) / self._period), 1) if is_known else 1


class Track(Generic[Place]):
    """The newest goals of a stream at times by one clock, and how rough it is by that clock."""

    def __init__(self, difference: Difference[Place]) -> None:
        self._difference = difference
        self.points = deque[tuple[float, Place]](maxlen=3)
        self.roughness = 0.0

    def add(self, time: float, place: Place) -> None:
        """The newest: its distance from the parabola through the last three is the roughness."""
        if len(self.points) == 3 and time > self.points[-1][0]:
            times = np.array([t for t, _ in self.points])
            away = np.array([self._difference(place, at) for _, at in self.points])
            missed = _extrapolation(times, time) @ away
            self.roughness = FORGET * self.roughness + float(missed @ missed)
        self.points.append((time, place))

    def flow(self) -> tuple[Array, Array, float, float]:
        """Twist (n,) and its derivative (n,) at the newest; the last two gaps, in seconds."""
        (first, begin), (middle, between), (last, newest) = self.points
        before, gap = middle - first, last - middle
        start = self._difference(begin, between) / before
        end = self._difference(between, newest) / gap
        change = 2.0 * (end - start) / (before + gap)
        return end + change * gap / 2.0, change, before, gap


def _extrapolation(times: Array, time: float) -> Array:
    """What each of three values at `times` (3,) counts at another time, by a parabola: (3,)."""
    others = times[[[1, 2], [0, 2], [0, 1]]]
    weights: Array = ((time - others) / (times[:, None] - others)).prod(axis=1)
    return weights


class Stream(Generic[Place]):
    """The newest goals of a sender, poses or joints; changes with each.

    Stamps say when each goal was meant, or only when it was sent, of goals that are even. Of both
    times those count by which the stream is smoother.
    """

    def __init__(self, delay: float, difference: Difference[Place]) -> None:
        """delay: seconds from the request of a plan to its beginning."""
        self._delay, self._difference = delay, difference
        self._clock = Clock()
        self._even, self._stamped = Track(difference), Track(difference)
        self._last = -np.inf
        self._due = 0.0

    def continued(self, goal: Goal, place: Place | None, now: float) -> Goal:
        """The goal, with its flow where it continues a stream; now in seconds.

        place: of the goal; None for one that continues none, and ends the stream.
        """
        noted = goal.stamp or goal.received or now
        if noted == self._last:  # the same one, once the machine has braked
            return goal
        even = self._clock.sent(noted)
        points = self._even.points
        is_back = bool(points) and even <= points[-1][0]
        if place is None or is_back or not 0.0 < noted - self._last <= LONGEST_GAP:
            self._even, self._stamped = Track(self._difference), Track(self._difference)
        if place is not None:
            self._last = noted
            self._even.add(even, place)
            self._stamped.add(goal.stamp or even, place)
        if len(self._even.points) < 3:
            self._due = -np.inf
            return replace(goal, flow=None)
        return replace(goal, flow=self._flow(now))

    def _flow(self, now: float) -> Flow:
        even, stamped = self._even, self._stamped
        is_even = even.roughness < CLEARLY * stamped.roughness
        twist, change, before, gap = (even if is_even else stamped).flow()
        between = max((before + gap) / 2.0, self._delay)
        late = max(GAPS * between, SHORTEST) + self._delay
        self._due = self._due_at(self._due + gap, now + late, late)
        until = now + 2.0 * between + self._delay + SLACK
        return Flow(twist, change, self._due, until)

    def _due_at(self, continued: float, anew: float, late: float) -> float:
        """When the goal is due: one gap after the last, drifting to the time by its receipt."""
        away = anew - continued
        return anew if abs(away) > late / 2.0 else continued + DRIFT * away
