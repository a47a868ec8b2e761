"""Jerk-limited moves from any state of motion to a pose at rest, by ruckig.

The six coordinates are the position and the rotation vector w with R = exp(w)·R_goal: the goal
lies at w = 0, far from the chart's edge at |w| = π.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import ruckig

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.trajectory.plan import MotionState

DIFFERENCE_STEP = 1e-4


@dataclass(frozen=True, eq=False)
class Move:
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
        return _state(x, v, a, self.goal.rotation)


def plan_move(start: MotionState, goal: Pose, limits: MotionLimits, slowness: float = 1.0) -> Move:
    """The quickest move within the limits on speed, acceleration and jerk of each coordinate.

    slowness k ≥ 1 divides speed by k, acceleration by k² and jerk by k³. Raises Refused where
    ruckig finds none.
    """
    request = ruckig.InputParameter(6)
    x, v, a = _coordinates(start, goal.rotation)
    request.current_position, request.current_velocity = x.tolist(), v.tolist()
    request.current_acceleration = a.tolist()
    request.target_position = [*goal.position.tolist(), 0.0, 0.0, 0.0]
    for name, power in (('speed', 1), ('acceleration', 2), ('jerk', 3)):
        bounds = [getattr(limits.linear, name) / slowness**power] * 3
        bounds += [getattr(limits.angular, name) / slowness**power] * 3
        ruckig_name = 'velocity' if name == 'speed' else name
        setattr(request, f'max_{ruckig_name}', bounds)
    trajectory = ruckig.Trajectory(6)
    result = ruckig.Ruckig(6).calculate(request, trajectory)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise Refused(f'no jerk-limited move was found ({result.name})')
    return Move(goal, float(trajectory.duration), trajectory)


def _coordinates(state: MotionState, reference: Array) -> tuple[Array, Array, Array]:
    """The state in the chart about `reference`: (6,) coordinates and two derivatives."""
    w = so3.log(state.pose.rotation @ reference.T)
    inverse = np.linalg.inv(so3.left_jacobian(w))
    w_rate = inverse @ state.twist[3:]
    w_acceleration = inverse @ (state.acceleration[3:] - _jacobian_change(w, w_rate))
    return (
        np.concatenate([state.pose.position, w]),
        np.concatenate([state.twist[:3], w_rate]),
        np.concatenate([state.acceleration[:3], w_acceleration]),
    )


def _state(x: Array, v: Array, a: Array, reference: Array) -> MotionState:
    """The inverse of `_coordinates`, for arrays of any shape."""
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
