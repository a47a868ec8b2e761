"""Streams of goals: followed with their own velocity, so that a smooth stream stays smooth.

A move to a goal ends at rest. Made anew for each goal of a stream, as quickly as limits allow, it
speeds up and brakes each time. Here the goals show how they move, and each is reached moving like
that, a little later than it came: docs/motion.md, section 6.
"""

from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from manipulator.arrays import Array
from manipulator.motion_limits import MotionLimits
from manipulator.planning.goal import Flow, Goal, Motion
from manipulator.planning.plan import MotionState, PosePlan
from manipulator.planning.point_to_point import (
    MoveInMotion,
    coordinates,
    plan_move_in_motion,
    state_of,
)
from manipulator.pose import Pose

LONGEST_GAP = 0.12
"""Seconds between two goals of a stream, by their stamps, or as they come where they have none."""

GAPS, SHORTEST = 2.5, 0.05
"""How much later than it comes a goal is reached: in gaps, but at least so many seconds."""

EXPECTED = 0.8
"""The part of this time in which the next goal must come; then the machine goes to rest."""

DRIFT = 0.03
"""The part of the difference of clocks, and of delays, that each goal corrects."""

LEAST_GAIN = 0.05
"""Of what a message without a stamp is late, that corrects the clock in the long run."""

STILL = 1e-6
"""m/s and rad/s that count as none."""


class Clock:
    """When messages without stamps were sent, if they are sent evenly: a line through arrivals."""

    def __init__(self) -> None:
        self._count = 0
        self._time = self._period = 0.0

    def sent(self, received: float) -> float:
        """For a message that was received then; the first one of another period begins anew."""
        late = received - (self._time + self._period)
        if self._count > 1 and abs(late) > self._period / 2.0:
            self._count = 0
        k = self._count = self._count + 1
        if k == 1:
            self._time, self._period = received, 0.0
            return received
        self._time += self._period + max((4 * k - 2) / (k * (k + 1)), LEAST_GAIN) * late
        self._period += max(6 / (k * (k + 1)), LEAST_GAIN**2) * late
        return self._time


class Stream:
    """The newest goals of a sender; changes with each."""

    def __init__(self, delay: float) -> None:
        """delay: seconds from the request of a plan to its beginning."""
        self._delay = delay
        self._clock = Clock()
        self._recent = deque[tuple[float, Pose]](maxlen=3)
        self._due = 0.0

    def continued(self, goal: Goal, now: float) -> Goal:
        """The goal, with its flow where it continues a stream; now in seconds."""
        is_simple = (
            goal.joints is None
            and goal.motion is not Motion.JOINT
            and (goal.then is None or isinstance(goal.then, Goal))
        )
        sent = goal.stamp or self._clock.sent(goal.received or now)
        last = self._recent[-1][0] if self._recent else -np.inf
        if not is_simple or not 0.0 < sent - last <= LONGEST_GAP:
            self._recent.clear()
        if is_simple:
            self._recent.append((sent, goal.pose))
        if len(self._recent) < 3:
            self._due = -np.inf
            return replace(goal, flow=None)
        (first, from_pose), (middle, by_pose), _ = self._recent
        before, gap = middle - first, sent - middle
        start = from_pose.twist_to(by_pose) / before
        end = by_pose.twist_to(goal.pose) / gap
        change = 2.0 * (end - start) / (before + gap)
        between = max((before + gap) / 2.0, self._delay)
        late = max(GAPS * between, SHORTEST) + self._delay
        self._due = self._due_at(self._due + gap, now + late, late)
        return replace(goal, flow=Flow(end + change * gap / 2.0, change, self._due))

    def _due_at(self, continued: float, anew: float, late: float) -> float:
        away = anew - continued
        return anew if abs(away) > late / 2.0 else continued + DRIFT * away


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


def plan_stream_move(
    start: MotionState, goal: Pose, flow: Flow, seconds: float, limits: MotionLimits
) -> StreamMove | None:
    """From any state to the goal with its flow in so many seconds; to rest if no other comes.

    None where a coordinate would pass its jerk. Raises Refused where there is no move to rest.
    """
    x, v, a = coordinates(start, goal.rotation)
    end = np.concatenate([goal.position, np.zeros(3)])
    coefficients = _quintic((x, v, a), (end, flow.twist, flow.acceleration), seconds)
    jerks = np.repeat([limits.linear.jerk, limits.angular.jerk], 3)
    if (np.abs(_jerk(coefficients, seconds)) > jerks[:, None]).any():
        return None
    span = seconds if np.abs(flow.twist).max() < STILL else EXPECTED * seconds
    x, v, a = (part[0] for part in _derivatives(coefficients, np.array([span])))
    state = state_of(x, v, a, goal.rotation)
    return StreamMove(coefficients, span, plan_move_in_motion(state, goal, limits))


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
