"""The move that follows a stream of goals: to the newest one in motion, then to rest.

A polynomial from the machine's state to the stream's, which joins any two states of motion.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.motion_limits import MotionLimits
from manipulator.planning.goal import Flow
from manipulator.planning.plan import MotionState, PosePlan
from manipulator.planning.point_to_point import (
    MoveInMotion,
    coordinates,
    plan_move_in_motion,
    state_of,
)
from manipulator.pose import Pose

SHORTEST = 0.05
"""Seconds in which a goal is reached, at least."""

EXPECTED = 0.8
"""The part of the time to a goal in which the next one must come, or the next but one by
`Flow.until` if that is later: one may be lost. Then the machine goes to rest."""

STILL = 1e-6
"""m/s and rad/s that count as none."""


@dataclass(frozen=True, eq=False)
class StreamMove(PosePlan):
    """Polynomials of the fifth degree in the local coordinates of the goal, then a move to rest.

    coefficients (6, 6), the constant ones first; they hold for the first `span` seconds.
    """

    coefficients: Array
    span: float
    rest: MoveInMotion

    @property
    def duration(self) -> float:
        """Seconds until rest at the goal."""
        return self.span + self.rest.duration

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...)."""
        flat = np.ravel(times)
        early, late = self._early(flat), self.rest.at(np.maximum(flat - self.span, 0.0))
        is_early = flat < self.span
        parts = []
        for first, second in (
            (early.pose.position, late.pose.position),
            (early.pose.rotation, late.pose.rotation),
            (early.twist, late.twist),
            (early.acceleration, late.acceleration),
        ):
            chosen = is_early.reshape(-1, *(1,) * (first.ndim - 1))
            both = np.where(chosen, first, second)
            parts.append(both.reshape(*np.shape(times), *first.shape[1:]))
        position, rotation, twist, acceleration = parts
        return MotionState(Pose(position, rotation), twist, acceleration)

    def where(self, time: float) -> str:
        """See `Plan`."""
        return f'at {100 * min(time / self.duration, 1.0):.0f} % of the time to the goal'

    def _early(self, times: Array) -> MotionState:
        """By the polynomials, at each of the times (n,)."""
        x, v, a = _derivatives(self.coefficients, np.clip(times, 0.0, self.span))
        return state_of(x, v, a, self.rest.goal.rotation)


@dataclass(frozen=True)
class Attempt:
    """later: by what part of the time to the goal the stream is met later, where it is by then.

    slowdown: of the move to rest, in case that no other goal comes.
    """

    later: float = 0.0
    slowdown: float = 1.0


STREAM_ATTEMPTS = Attempt(), Attempt(slowdown=1.5), Attempt(1.0, 1.5), Attempt(3.0, 2.0)
"""In this order: a machine that is off the stream, or begins it, needs time to catch up."""


def plan_stream_move(
    start: MotionState, goal: Pose, flow: Flow, time: float, limits: MotionLimits, how: Attempt
) -> StreamMove | None:
    """From any state, at that time, to the goal with its flow; to rest if no other comes.

    None where a coordinate would pass its jerk. Raises Refused where there is no move to rest.
    """
    seconds = max(flow.due - time, SHORTEST / 2.0)
    span = seconds
    if np.abs(flow.twist).max() >= STILL:
        span = max(EXPECTED * seconds, flow.until - time)
    beyond = max(span - seconds, how.later * seconds)
    v = flow.twist + beyond * flow.acceleration
    end = np.concatenate([goal.position, np.zeros(3)]) + beyond * (flow.twist + v) / 2.0
    coefficients = _quintic(
        coordinates(start, goal.rotation), (end, v, flow.acceleration), seconds + beyond
    )
    jerks = np.repeat([limits.linear.jerk, limits.angular.jerk], 3)
    if (np.abs(_jerk(coefficients, seconds + beyond)) > jerks[:, None]).any():
        return None
    x, v, a = (part[0] for part in _derivatives(coefficients, np.array([span])))
    state = state_of(x, v, a, goal.rotation)
    rest = plan_move_in_motion(state, goal, limits, how.slowdown)
    return StreamMove(coefficients, span, rest)


Ends = tuple[Array, Array, Array]
"""Six coordinates with two derivatives."""


def _quintic(start: Ends, end: Ends, seconds: float) -> Array:
    """Coefficients (6, 6) of the polynomials from one to the other, the constant ones first."""
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


def _derivatives(coefficients: Array, times: Array) -> tuple[Array, Array, Array]:
    """Coordinates (n, 6), with two derivatives, at times (n,)."""
    powers = times[:, None] ** np.arange(6)
    factors = np.arange(1.0, 6.0)
    first = coefficients[1:] * factors[:, None]
    second = first[1:] * factors[:4, None]
    return powers @ coefficients, powers[:, :5] @ first, powers[:, :4] @ second


def _jerk(coefficients: Array, seconds: float) -> Array:
    """Of each coordinate at begin, middle and end, (6, 3): between them it bends but once."""
    times = seconds * np.array([0.0, 0.5, 1.0])
    powers = times[:, None] ** np.arange(3)
    jerk: Array = (powers @ (coefficients[3:] * np.array([6.0, 24.0, 60.0])[:, None])).T
    return jerk
