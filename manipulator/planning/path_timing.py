"""A path with its timing: a plan like any other, made and checked before it begins.

Speed and acceleration of joints and platform are limited; jerk is not, except by the corners'
width and by the drives themselves.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.machine import Machine
from manipulator.planning.check import TOLERANCE as CHECK_TOLERANCE
from manipulator.planning.check import check_plan
from manipulator.planning.orientation import OrientationRule
from manipulator.planning.path import Path, Tolerance, path_along, path_in_time
from manipulator.planning.path_limits import PathLimits, fastest, path_limits
from manipulator.planning.plan import MotionState, Plan
from manipulator.planning.worker import Effort
from manipulator.pose import Pose

FEWEST_INTERVALS = 500
NODE_STEP = 0.1
MOST_PIECES = 200
"""Between two nodes of the path's own; what moves farther there has left every reach."""
REFINEMENTS = (1, 2, 4)
MOST_TICKS = 100_000
"""Of a path: 1000 s at 100 Hz."""


@dataclass(frozen=True, eq=False)
class TimedPath(Plan):
    """Squared speeds along the path at its nodes (m + 1,); between them s̈ is constant.

    joints are those at the first pose: another branch of them cannot drive this plan. is_stamped:
    its poses have times of their own, so that it is never slowed down for the sake of accuracy.
    """

    path: Path
    nodes: Array
    squares: Array
    joints: Array
    is_stamped: bool = False

    @cached_property
    def _times(self) -> Array:
        speeds = np.sqrt(self.squares)
        steps = 2 * np.diff(self.nodes) / np.maximum(speeds[:-1] + speeds[1:], 1e-12)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return float(self._times[-1])

    def percent(self, time: float) -> int:
        """How much of its time is over at the last half second before `time`."""
        return int(100 * (time // 0.5 * 0.5) / self.duration)

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...)."""
        s, rate, pull = (value[..., None] for value in self._progress(times))
        point = self.path.at(s[..., 0])
        acceleration = point.acceleration * rate**2 + point.twist * pull
        return MotionState(point.pose, point.twist * rate, acceleration)

    def where(self, time: float) -> str:
        """See `Plan`: by the poses' numbers and the length, whatever the timing is."""
        return self.path.where(float(self._progress(time)[0]))

    def _progress(self, times: Array | float) -> tuple[Array, Array, Array]:
        """The path's parameter s, ṡ and s̈ at each of the times (...)."""
        t = np.clip(np.asarray(times, dtype=np.float64), 0.0, self.duration)
        last = len(self.nodes) - 2
        i = np.minimum(np.searchsorted(self._times, t, side='right') - 1, last)
        step = self.nodes[i + 1] - self.nodes[i]
        pull = (self.squares[i + 1] - self.squares[i]) / (2 * step)
        begin, into = np.sqrt(self.squares[i]), t - self._times[i]
        s = self.nodes[i] + (begin + pull * into / 2) * into
        return s, np.maximum(begin + pull * into, 0.0), pull


@dataclass(frozen=True, eq=False)
class PathRequest:
    """Poses (n,) to pass, n ≥ 1; at their stamps (s, (n,)), or at `speed` (m/s) at most.

    numbers (n,): those by which their sender knows them; None: from 1.
    """

    poses: Pose
    speed: float
    tolerance: Tolerance
    stamps: Array | None = None
    numbers: tuple[int, ...] | None = None

    def oriented(self, rule: OrientationRule, start: Pose) -> 'PathRequest':
        """With the orientations by a rule, and perhaps more poses; see `OrientationRule.along`."""
        if rule.is_given:
            return self
        poses, places = rule.along(self.poses, start)
        stamps = self.stamps
        if stamps is not None:
            stamps = np.interp(places, np.arange(len(stamps)), stamps)
        numbers = tuple(int(place) + 1 for place in places)
        return replace(self, poses=poses, stamps=stamps, numbers=numbers)


def plan_path(
    machine: Machine, request: PathRequest, near: Array, dt: float, effort: Effort | None = None
) -> TimedPath | Pose:
    """The plan, checked at every tick dt; or the one pose to go to, where all are the same.

    near: the joints from which the first pose is approached. Raises Refused, saying at which pose
    and how many metres along the path, where it leaves the reach or is stamped too fast.
    """
    turn_length = machine.motion.linear.speed / machine.motion.angular.speed
    if request.stamps is not None and len(request.stamps) > 1:
        path: Path | Pose = path_in_time(
            request.poses, request.stamps, request.tolerance, request.numbers
        )
        speed = 1.0
    else:
        path = path_along(request.poses, request.tolerance, turn_length, request.numbers)
        speed = request.speed
    if isinstance(path, Pose):
        return path
    effort, length = effort or Effort(), machine.kinematics.characteristic_length
    for refinement in REFINEMENTS:
        limits = path_limits(machine, path, nodes_of(path, refinement, length), near)
        if request.stamps is not None:
            _check_stamped(path, limits)
        timed = replace(timed_path(path, limits, speed), is_stamped=request.stamps is not None)
        _check_length(timed, dt)
        peak = check_plan(timed, machine, near, dt, effort)
        if peak.fits:
            return timed
    if request.stamps is None:
        slower = replace(timed, squares=timed.squares / (1.01 * peak.factor) ** 2)
        if check_plan(slower, machine, near, dt, effort).fits:
            return slower
    raise Refused(
        f'{peak.quantity} stays {peak.factor:.3f} times too high {timed.where(peak.time)}'
    )


def nodes_of(path: Path, refinement: int, length: float) -> Array:
    """Values of s: poses, the ends of their blends, and points between, close enough.

    Between two of them the machine moves at most NODE_STEP of its characteristic length (m), or
    of a radian: so joints that jump from one to the next have changed their branch.
    """
    own = np.unique(np.concatenate([path.marks - path.blends, path.marks + path.blends]))
    spans = np.diff(own)
    own = own[np.concatenate([[True], spans > 1e-9 * own[-1]])]
    spans = np.diff(own)
    middle = np.searchsorted(path.marks, (own[1:] + own[:-1]) / 2) - 1
    rates = path.rates[middle]
    moved = np.linalg.norm(rates[:, :3], axis=1) / length + np.linalg.norm(rates[:, 3:], axis=1)
    pieces = np.maximum(
        spans / (own[-1] / FEWEST_INTERVALS), np.minimum(spans * moved / NODE_STEP, MOST_PIECES)
    )
    pieces = refinement * np.maximum(np.ceil(pieces).astype(int), 2)
    steps = np.repeat(spans / pieces, pieces)
    nodes: Array = np.concatenate([[0.0], np.cumsum(steps)])
    return nodes


def timed_path(path: Path, limits: PathLimits, speed: float) -> TimedPath:
    """The fastest timing of a path at `speed` (per second, in the path's parameter) at most."""
    highest = np.minimum(limits.highest.min(axis=1), speed**2)
    return TimedPath(path, limits.nodes, fastest(limits.rows, highest), limits.joints[0])


def _check_stamped(path: Path, limits: PathLimits) -> None:
    utilisation, quantity, s = limits.most_at(1.0)
    if utilisation > CHECK_TOLERANCE:
        raise Refused(
            f'{path.where(s)}: by the stamps of the poses {quantity} would be '
            f'{utilisation:.3g} times too fast'
        )


def _check_length(timed: TimedPath, dt: float) -> None:
    if timed.duration > MOST_TICKS * dt:
        raise Refused(
            f'the path would take {timed.duration:.0f} s, at most {MOST_TICKS * dt:.0f} s'
        )
