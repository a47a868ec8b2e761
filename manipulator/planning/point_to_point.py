"""Jerk-limited point-to-point moves by ruckig: from rest along a line, or from any motion.

From rest to rest s(t) goes from 0 to 1, the quickest within bounds on ṡ, s̈ and s⃛, along a straight
line and a turn about one fixed axis. From any state of motion six local coordinates move at once:
the position, and w with R = exp(w)·R₀, together x (..., 6). R₀ is the goal's, so the goal lies at
w = 0, far from the edge at |w| = π. docs/motion.md, section 2.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import ruckig

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.motion_limits import MotionLimits
from manipulator.planning.plan import MotionState, PosePlan
from manipulator.pose import Pose

FASTEST = 1e9
"""1/s and so on: bounds of what does not move at all."""


@dataclass(frozen=True, eq=False)
class Profile:
    """A ruckig trajectory of one coordinate."""

    duration: float
    _trajectory: Any

    def at(self, times: Array | float) -> tuple[Array, Array, Array]:
        """s, ṡ and s̈ at each of the times (...), those of the ends before and after."""
        flat = np.clip(np.ravel(times), 0.0, self.duration)
        samples = np.array([self._trajectory.at_time(t)[:3] for t in flat.tolist()])
        s, rate, pull = np.moveaxis(samples.reshape(*np.shape(times), 3), -1, 0)
        return np.clip(s, 0.0, 1.0), rate, pull


def profile_within(bounds: Sequence[float], slowdown: float = 1.0) -> Profile:
    """bounds: the most that ṡ, s̈ and s⃛ may be; slowdown k ≥ 1 makes it take k times as long."""
    request = ruckig.InputParameter(1)
    request.target_position = [1.0]
    names = ('velocity', 'acceleration', 'jerk')
    for power, (name, bound) in enumerate(zip(names, bounds, strict=True), start=1):
        setattr(request, f'max_{name}', [min(bound, FASTEST) / slowdown**power])
    trajectory = _calculated(request, 1)
    return Profile(float(trajectory.duration), trajectory)


def _calculated(request: Any, axes: int) -> Any:
    """Ruckig's trajectory; Refused where it finds none, by a result or by an exception."""
    trajectory = ruckig.Trajectory(axes)
    try:
        result = ruckig.Ruckig(axes).calculate(request, trajectory)
    except ValueError as error:  # of a result without a name in Python: -101, of the duration
        raise Refused('no jerk-limited move was found: it would take too long') from error
    except ruckig.RuckigError as error:
        text = ' '.join(str(error).split()).removeprefix('[ruckig] ').partition(' input:')[0]
        raise Refused(f'no jerk-limited move was found ({text})') from error
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise Refused(f'no jerk-limited move was found ({result.name})')
    return trajectory


DIFFERENCE_STEP = 1e-4


def coordinates(state: MotionState, reference: Array) -> tuple[Array, Array, Array]:
    """One state in local coordinates about `reference` (3, 3): (6,), with two derivatives."""
    w = so3.log(state.pose.rotation @ reference.T)
    inverse = np.linalg.inv(so3.left_jacobian(w))
    w_rate = inverse @ state.twist[3:]
    w_acceleration = inverse @ (state.acceleration[3:] - _jacobian_change(w, w_rate))
    return (
        np.concatenate([state.pose.position, w]),
        np.concatenate([state.twist[:3], w_rate]),
        np.concatenate([state.acceleration[:3], w_acceleration]),
    )


def state_of(x: Array, v: Array, a: Array, reference: Array) -> MotionState:
    """The inverse of `coordinates`, for arrays of any shape; reference (..., 3, 3)."""
    w, w_rate = x[..., 3:], v[..., 3:]
    jacobian = so3.left_jacobian(w)
    omega = np.einsum('...ij,...j->...i', jacobian, w_rate)
    alpha = np.einsum('...ij,...j->...i', jacobian, a[..., 3:]) + _jacobian_change(w, w_rate)
    return MotionState(
        Pose(x[..., :3], so3.exp(w) @ reference),
        np.concatenate([v[..., :3], omega], axis=-1),
        np.concatenate([a[..., :3], alpha], axis=-1),
    )


def _jacobian_change(w: Array, w_rate: Array) -> Array:
    """J̇(w)·ẇ by a central difference along ẇ."""
    h = DIFFERENCE_STEP
    ahead, behind = so3.left_jacobian(w + h * w_rate), so3.left_jacobian(w - h * w_rate)
    change: Array = np.einsum('...ij,...j->...i', (ahead - behind) / (2 * h), w_rate)
    return change


@dataclass(frozen=True, eq=False)
class LineMove(PosePlan):
    """start.moved(s·d): s goes from 0 to 1 along the profile, d (6,) is start.twist_to(goal)."""

    start: Pose
    displacement: Array
    profile: Profile

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return self.profile.duration

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

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
class MoveInMotion(PosePlan):
    """A ruckig trajectory in the coordinates about the goal's orientation."""

    goal: Pose
    duration: float
    _trajectory: Any

    @property
    def checked_duration(self) -> float:
        """All of it."""
        return self.duration

    def at(self, times: Array | float) -> MotionState:
        """Position, velocity and acceleration of the coordinates, turned into a state."""
        flat = np.clip(np.ravel(times), 0.0, self.duration)
        samples = np.array([self._trajectory.at_time(t)[:3] for t in flat.tolist()])
        x, v, a = np.moveaxis(samples.reshape(*np.shape(times), 3, 6), -2, 0)
        return state_of(x, v, a, self.goal.rotation)

    def where(self, time: float) -> str:
        """See `Plan`."""
        return f'at {100 * min(time / self.duration, 1.0):.0f} % of the time to the goal'


def plan_move_in_motion(
    start: MotionState, goal: Pose, limits: MotionLimits, slowdown: float = 1.0
) -> MoveInMotion:
    """The quickest move within the limits on speed, acceleration and jerk of each coordinate.

    slowdown k ≥ 1 divides speed by k, acceleration by k² and jerk by k³. Raises Refused where
    ruckig finds none.
    """
    request = ruckig.InputParameter(6)
    x, v, a = coordinates(start, goal.rotation)
    request.current_position, request.current_velocity = x.tolist(), v.tolist()
    request.current_acceleration = a.tolist()
    request.target_position = [*goal.position.tolist(), 0.0, 0.0, 0.0]
    for name, power in (('speed', 1), ('acceleration', 2), ('jerk', 3)):
        bounds = [getattr(limits.linear, name) / slowdown**power] * 3
        bounds += [getattr(limits.angular, name) / slowdown**power] * 3
        if name == 'speed':
            bounds = np.minimum(bounds, limits.axis_speeds / slowdown).tolist()
        ruckig_name = 'velocity' if name == 'speed' else name
        setattr(request, f'max_{ruckig_name}', bounds)
    trajectory = _calculated(request, 6)
    return MoveInMotion(goal, float(trajectory.duration), trajectory)
