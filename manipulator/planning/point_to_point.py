"""Jerk-limited point-to-point moves by ruckig: from rest along a line, or from any motion.

From rest to rest s(t) goes from 0 to 1, the quickest within bounds on ṡ, s̈ and s⃛, along a straight
line and a turn about one fixed axis. From any state of motion six local coordinates move at once:
the position, and w with R = exp(w)·R₀, together x (..., 6). R₀ is the goal's, so the goal lies at
w = 0, far from the edge at |w| = π. docs/motion.md, section 2.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import ruckig

from manipulator import rotation as so3
from manipulator.arrays import Array, frozen
from manipulator.errors import Refused
from manipulator.motion_limits import MotionLimits
from manipulator.planning.plan import CoordinateCurve, MotionState, Plan
from manipulator.pose import Pose

FASTEST = 1e9
"""1/s and so on: bounds of what does not move at all."""


@dataclass(frozen=True, eq=False)
class Cubics:
    """A ruckig trajectory of d coordinates as its polynomials: plans keep no object of ruckig.

    Each coordinate has its own times `begins` (d, k), and from each of them on a cubic: position,
    velocity, acceleration and jerk there, `states` (4, d, k).
    """

    duration: float
    begins: Array
    states: Array

    @staticmethod
    def of(trajectory: ruckig.Trajectory) -> 'Cubics':
        """Its braking to within the bounds, its seven phases, and the rest at its end."""
        (profiles,) = trajectory.profiles
        lasting = np.array([[*one.brake.t, *one.t] for one in profiles])
        begins = np.pad(np.cumsum(lasting, axis=1), ((0, 0), (1, 0)))
        states = [
            [[*getattr(one.brake, name), *getattr(one, name)] for one in profiles]
            for name in ('p', 'v', 'a')
        ]
        jerks = [[*one.brake.j, *one.j, 0.0] for one in profiles]
        return Cubics(float(trajectory.duration), frozen(begins), frozen([*states, jerks]))

    def at(self, times: Array | float) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations (..., d) at the times (...).

        Those of the ends before and after.
        """
        t = np.clip(times, 0.0, self.duration)[..., None]
        phase = (self.begins <= t[..., None]).sum(axis=-1) - 1
        each = np.arange(len(self.begins))
        t = t - self.begins[each, phase]
        p, v, a, j = self.states[:, each, phase]
        return p + t * (v + t * (a / 2 + t * (j / 6))), v + t * (a + t * (j / 2)), a + t * j


@dataclass(frozen=True, eq=False)
class Profile:
    """A trajectory of one coordinate, from 0 to 1."""

    cubics: Cubics

    @property
    def duration(self) -> float:
        """Seconds from 0 to 1."""
        return self.cubics.duration

    def at(self, times: Array | float) -> tuple[Array, Array, Array]:
        """s, ṡ and s̈ at each of the times (...), those of the ends before and after."""
        s, rate, pull = self.cubics.at(times)
        return np.clip(s[..., 0], 0.0, 1.0), rate[..., 0], pull[..., 0]


def profile_within(bounds: Sequence[float], slowdown: float = 1.0) -> Profile:
    """bounds: the most that ṡ, s̈ and s⃛ may be; slowdown k ≥ 1 makes it take k times as long."""
    request = ruckig.InputParameter(1)
    request.target_position = [1.0]
    names = ('velocity', 'acceleration', 'jerk')
    for power, (name, bound) in enumerate(zip(names, bounds, strict=True), start=1):
        setattr(request, f'max_{name}', [min(bound, FASTEST) / slowdown**power])
    return Profile(_calculated(request, 1))


def _calculated(request: ruckig.InputParameter, coordinates: int) -> Cubics:
    """The trajectory of so many coordinates; Refused where ruckig finds none, or fails."""
    trajectory = ruckig.Trajectory(coordinates)
    try:
        result = ruckig.Ruckig(coordinates).calculate(request, trajectory)
    except ValueError as error:  # of a result without a name in Python: -101, of the duration
        raise Refused('no jerk-limited move was found: it would take too long') from error
    except ruckig.RuckigError as error:
        text = ' '.join(str(error).split()).removeprefix('[ruckig] ').partition(' input:')[0]
        raise Refused(f'no jerk-limited move was found (ruckig: {text})') from error
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise Refused(f'no jerk-limited move was found ({result.name})')
    return Cubics.of(trajectory)


def coordinates(state: MotionState, reference: Array) -> tuple[Array, Array, Array]:
    """One state in local coordinates about `reference` (3, 3): (6,), with two derivatives."""
    w = so3.log(state.pose.rotation @ reference.T)
    inverse = np.linalg.inv(so3.left_jacobian(w))
    w_rate = inverse @ state.twist[3:]
    _, change = so3.turning(w, w_rate, np.zeros(3))
    w_acceleration = inverse @ (state.acceleration[3:] - change)
    return (
        np.concatenate([state.pose.position, w]),
        np.concatenate([state.twist[:3], w_rate]),
        np.concatenate([state.acceleration[:3], w_acceleration]),
    )


def state_of(x: Array, v: Array, a: Array, reference: Array) -> MotionState:
    """The inverse of `coordinates`, for arrays of any shape; reference (..., 3, 3)."""
    w = x[..., 3:]
    omega, alpha = so3.turning(w, v[..., 3:], a[..., 3:])
    return MotionState(
        Pose(x[..., :3], so3.exp(w) @ reference),
        np.concatenate([v[..., :3], omega], axis=-1),
        np.concatenate([a[..., :3], alpha], axis=-1),
    )


@dataclass(frozen=True, eq=False)
class LineMove(Plan):
    """start.moved(s·d): s goes from 0 to 1 along the profile, d (6,) is start.twist_to(goal)."""

    start: Pose
    displacement: Array
    profile: Profile

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return self.profile.duration

    def at(self, times: Array | float) -> MotionState:
        """The state at each of the times (...)."""
        s, rate, pull = (value[..., None] for value in self.profile.at(times))
        position = self.start.position + s * self.displacement[:3]
        turn = so3.exp(s * self.displacement[3:]) @ self.start.rotation
        return MotionState(
            Pose(position, turn), rate * self.displacement, pull * self.displacement
        )

    def where(self, time: float) -> str:
        """See `Plan`."""
        share, _, _ = self.profile.at(time)
        return f'at {100 * float(share):.0f} % of the line'


def plan_line_move(
    start: Pose, goal: Pose, limits: MotionLimits, slowdown: float = 1.0
) -> LineMove:
    """The quickest such move; slowdown k ≥ 1 makes it take k times as long."""
    displacement = start.twist_to(goal)
    lengths = (
        float(np.linalg.norm(displacement[:3])),
        float(np.linalg.norm(displacement[3:])),
    )
    parts = tuple(zip((limits.linear, limits.angular), lengths, strict=True))
    bounds = [
        min(
            getattr(limit, name) / length if length > getattr(limit, name) / FASTEST else FASTEST
            for limit, length in parts
        )
        for name in ('speed', 'acceleration', 'jerk')
    ]
    used = float(limits.speed_shares(displacement).max())
    bounds[0] = min(bounds[0], 1.0 / max(used, 1.0 / FASTEST))
    return LineMove(start, displacement, profile_within(bounds, slowdown))


@dataclass(frozen=True, eq=False)
class MoveInMotion(Plan):
    """A curve of the six local coordinates about the goal's orientation."""

    goal: Pose
    curve: CoordinateCurve

    @property
    def duration(self) -> float:
        """Seconds until rest at the goal."""
        return self.curve.duration

    def at(self, times: Array | float) -> MotionState:
        """Position, velocity and acceleration of the coordinates, turned into a state."""
        x, v, a = self.curve.at(times)
        return state_of(x, v, a, self.goal.rotation)

    def where(self, time: float) -> str:
        """See `Plan`."""
        share = min(time / max(self.duration, 1e-9), 1.0)
        return f'at {100 * share:.0f} % of the time to the goal'


def plan_move_in_motion(
    start: MotionState, goal: Pose, limits: MotionLimits, slowdown: float = 1.0
) -> MoveInMotion:
    """The quickest move within the limits on speed, acceleration and jerk of each coordinate.

    Slowdown and errors: see `quickest`.
    """
    begin, end = coordinates(start, goal.rotation), coordinates_of_goal(goal)
    return MoveInMotion(goal, quickest(begin, end, coordinate_bounds(limits), slowdown))


def coordinates_of_goal(goal: Pose) -> Array:
    """Local coordinates (6,) of a goal about its own orientation."""
    return np.concatenate([goal.position, np.zeros(3)])


def coordinate_bounds(limits: MotionLimits) -> tuple[Array, Array, Array]:
    """The most speed, acceleration and jerk of each of the six local coordinates, (6,) each."""
    speed, acceleration, jerk = (
        np.repeat([getattr(part, name) for part in (limits.linear, limits.angular)], 3)
        for name in ('speed', 'acceleration', 'jerk')
    )
    return np.minimum(speed, limits.axis_speeds), acceleration, jerk


def quickest(
    start: tuple[Array, Array, Array],
    target: Array,
    bounds: tuple[Array, Array, Array],
    slowdown: float = 1.0,
) -> Cubics:
    """The move from coordinates with two derivatives, each (n,), to rest at a target.

    bounds: of speed, acceleration and jerk, (n,) each; slowdown k ≥ 1 divides them by k, k², k³.
    Raises Refused where there is no such move.
    """
    request = ruckig.InputParameter(len(target))
    for name, values in zip(('position', 'velocity', 'acceleration'), start, strict=True):
        setattr(request, f'current_{name}', values.tolist())
    request.target_position = target.tolist()
    names = ('velocity', 'acceleration', 'jerk')
    for power, (name, most) in enumerate(zip(names, bounds, strict=True), start=1):
        setattr(request, f'max_{name}', np.minimum(most / slowdown**power, FASTEST).tolist())
    return _calculated(request, len(target))
