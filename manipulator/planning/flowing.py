"""Moves that follow a stream of goals, of poses or of joints: docs/motion.md, section 6.

Each coordinate joins the stream by a polynomial of the fifth degree. It holds until the next goal
but one must have come; what follows is a move to rest.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.motion_limits import MotionLimits
from manipulator.planning.goal import Flow
from manipulator.planning.joint_curve import Curve, quintic
from manipulator.planning.plan import Ends, MotionState
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
"""Seconds from a goal's receipt to when it is due, at least; half of them may be left."""

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


@dataclass(frozen=True, eq=False)
class Flowing:
    """Coordinates (n,) over time: `early` along a stream, then `rest`, if no other goal comes."""

    early: Curve
    rest: Cubics

    @property
    def duration(self) -> float:
        """Seconds until rest."""
        return self.early.duration + self.rest.duration

    def at(self, times: Array | float) -> Ends:
        """See `CoordinateCurve`."""
        flat, span = np.ravel(times), self.early.duration
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
    end = early.at(early.duration)
    return Flowing(early, quickest(end, goal, bounds, how.slowdown))


def quintic_to(
    start: Ends, goal: Array, flow: Flow, time: float, jerks: Array, later: float
) -> Curve | None:
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
    coefficients = np.array(quintic(start, (end, v, flow.acceleration), seconds + beyond))
    if (_most_jerk(coefficients, seconds + beyond) > jerks).any():
        return None
    return Curve(frozen([0.0, span]), frozen(coefficients[None]))


def _most_jerk(coefficients: Array, seconds: float) -> Array:
    """Of each coordinate (n,): at begin or end, or where the parabola in between turns."""
    first, second, third = coefficients[3:] * np.array([6.0, 24.0, 60.0])[:, None]
    steep = np.where(third == 0.0, 1.0, third)
    turns = np.clip(-second / (2.0 * steep), 0.0, seconds)
    times = np.array([np.zeros_like(turns), turns, np.full_like(turns, seconds)])
    most: Array = np.abs(first + times * (second + times * third)).max(axis=0)
    return most
