"""Moves that follow a stream of goals, of poses or of joints: docs/motion.md, section 6.

Each coordinate joins the stream by a polynomial of the fifth degree. It holds until the next goal
but one must have come; what follows is a move to rest.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.motion_limits import MotionLimits
from manipulator.planning.goal import Flow
from manipulator.planning.plan import MotionState
from manipulator.planning.point_to_point import (
    Cubics,
    MoveInMotion,
    coordinate_bounds,
    coordinates,
    coordinates_of_goal,
    quickest,
)
from manipulator.pose import Pose

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


@dataclass(frozen=True, eq=False)
class Flowing:
    """Coordinates (n,) over time: `early` along a stream, then `rest`, if no other goal comes."""

    early: Quintic
    rest: Cubics

    @property
    def duration(self) -> float:
        """Seconds until rest."""
        return self.early.span + self.rest.duration

    def at(self, times: Array | float) -> Ends:
        """See `CoordinateCurve`."""
        flat, span = np.ravel(times), self.early.span
        is_early = (flat < span)[:, None]
        both = zip(self.early.at(flat), self.rest.at(flat - span), strict=True)
        x, v, a = (
            np.where(is_early, early, late).reshape(*np.shape(times), -1) for early, late in both
        )
        return x, v, a


def plan_stream_move(
    start: MotionState, goal: Pose, flow: Flow, time: float, limits: MotionLimits, how: Attempt
) -> MoveInMotion | None:
    """From any state, at that time, to the goal with its flow; errors: see `flowing_to`."""
    begin, end = coordinates(start, goal.rotation), coordinates_of_goal(goal)
    curve = flowing_to(begin, end, flow, time, coordinate_bounds(limits), how)
    return None if curve is None else MoveInMotion(goal, curve)


def flowing_to(
    start: Ends, goal: Array, flow: Flow, time: float, bounds: Ends, how: Attempt
) -> Flowing | None:
    """From any motion, at that time, to the goal (n,) with its flow; to rest if no other comes.

    bounds: of speed, acceleration and jerk, (n,) each. None where a coordinate would pass its
    jerk. Raises Refused where there is no move to rest.
    """
    early = quintic_to(start, goal, flow, time, bounds[2], how.later)
    if early is None:
        return None
    return Flowing(early, quickest(early.end, goal, bounds, how.slowdown))


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
