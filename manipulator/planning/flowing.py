"""Polynomials of the fifth degree that join a motion to a stream of goals, each coordinate alone.

They hold until the next goal but one must have come; what follows is a move to rest.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.planning.goal import Flow

SHORTEST = 0.05
"""Seconds in which a goal is reached, at least."""

EXPECTED = 0.8
"""The part of the time to a goal in which the next one must come, or the next but one by
`Flow.until` if that is later: one may be lost. Then the machine goes to rest."""

STILL = 1e-6
"""m/s and rad/s that count as none."""


@dataclass(frozen=True)
class Attempt:
    """later: by what part of the time to the goal the stream is met later, where it is by then.

    slowdown: of the move to rest, in case that no other goal comes.
    """

    later: float = 0.0
    slowdown: float = 1.0


ATTEMPTS = (
    Attempt(),
    Attempt(slowdown=1.5),
    *(Attempt(later, 2.0) for later in (1.0, 3.0, 7.0, 15.0)),
)
"""In this order: a machine that is off the stream, or begins it, needs time to catch up."""

Ends = tuple[Array, Array, Array]
"""Coordinates (n,) with two derivatives."""


@dataclass(frozen=True, eq=False)
class Quintic:
    """coefficients (6, n), the constant ones first; they hold for the first `span` seconds."""

    coefficients: Array
    span: float

    def at(self, times: Array) -> Ends:
        """Coordinates (k, n), with two derivatives, at times (k,), those of the ends outside."""
        powers = np.clip(times, 0.0, self.span)[:, None] ** np.arange(6)
        factors = np.arange(1.0, 6.0)
        first = self.coefficients[1:] * factors[:, None]
        second = first[1:] * factors[:4, None]
        return powers @ self.coefficients, powers[:, :5] @ first, powers[:, :4] @ second

    @property
    def end(self) -> Ends:
        """At the end of the span."""
        x, v, a = (part[0] for part in self.at(np.array([self.span])))
        return x, v, a


def quintic_to(
    start: Ends, goal: Array, flow: Flow, time: float, jerks: Array, later: float
) -> Quintic | None:
    """From any motion, at that time, to the goal (n,) with its flow; later: see `Attempt`.

    None where a coordinate would pass its jerk (n,).
    """
    seconds = max(flow.due - time, SHORTEST / 2.0)
    span = seconds
    if np.abs(flow.twist).max() >= STILL:
        span = max(EXPECTED * seconds, flow.until - time)
    beyond = max(span - seconds, later * seconds)
    v = flow.twist + beyond * flow.acceleration
    end = goal + beyond * (flow.twist + v) / 2.0
    coefficients = _coefficients(start, (end, v, flow.acceleration), seconds + beyond)
    if (np.abs(_jerk(coefficients, seconds + beyond)) > jerks[:, None]).any():
        return None
    return Quintic(coefficients, span)


def _coefficients(start: Ends, end: Ends, seconds: float) -> Array:
    """Of the polynomials from one to the other, (6, n)."""
    x, v, a = start
    left = end[0] - (x + seconds * (v + seconds * a / 2.0))
    faster = (end[1] - (v + seconds * a)) * seconds
    harder = (end[2] - a) * seconds**2
    return np.array(
        [
            x,
            v,
            a / 2.0,
            (10.0 * left - 4.0 * faster + harder / 2.0) / seconds**3,
            (-15.0 * left + 7.0 * faster - harder) / seconds**4,
            (6.0 * left - 3.0 * faster + harder / 2.0) / seconds**5,
        ]
    )


def _jerk(coefficients: Array, seconds: float) -> Array:
    """Of each coordinate at begin, middle and end, (n, 3): between them it bends but once."""
    times = seconds * np.array([0.0, 0.5, 1.0])
    powers = times[:, None] ** np.arange(3)
    jerk: Array = (powers @ (coefficients[3:] * np.array([6.0, 24.0, 60.0])[:, None])).T
    return jerk
