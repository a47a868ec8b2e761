"""What the demonstration measured: the board's true joint angles against the commands."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array, Mask
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

LONGEST_LAG, LAG_STEP = 0.3, 0.001


@dataclass(frozen=True)
class Curve:
    """The commanded pose, as a function of the time since `begin` (Unix time)."""

    pose_at: Callable[[float], Pose]
    begin: float
    duration: float


@dataclass(frozen=True, eq=False)
class Observation:
    """True joints (n, 6) at Unix times (n,), straight moves commanded at their times, a curve."""

    times: Array
    joints: Array
    corners: tuple[tuple[float, Pose], ...]
    curve: Curve
    bridge: dict[str, str]
    goals_refused: int


@dataclass(frozen=True, eq=False)
class Result:
    """Errors in metres and radians at each time (n,), the lag in seconds."""

    observation: Observation
    poses: Pose
    contour: Array
    lag: float
    orientation: Array

    def rows(self) -> Iterator[tuple[str, str]]:
        """The table, a line each."""
        bridge, contour = self.observation.bridge, self.contour[np.isfinite(self.contour)] * 1e3
        turn = np.degrees(self.orientation[np.isfinite(self.orientation)])
        yield 'contour error rms, max', f'{_rms(contour):.3f} mm, {contour.max():.3f} mm'
        yield 'time lag on the circle', f'{self.lag * 1e3:.0f} ms'
        yield 'orientation error rms, max', f'{_rms(turn):.3f}°, {turn.max():.3f}°'
        p50, p99 = (bridge[f'setpoint_to_frame_{p}_ms'] for p in ('p50', 'p99'))
        yield 'setpoint to frame written p50, p99', f'{p50} ms, {p99} ms'
        yield 'frames sent', bridge['frames_sent']
        yield 'goals refused (one was out of reach)', str(self.observation.goals_refused)


def measure(observation: Observation, kinematics: Kinematics) -> Result:
    """Poses by forward kinematics of the true angles, and their errors."""
    poses = _poses(observation.joints, kinematics)
    contour = np.full(len(observation.times), np.nan)
    orientation = contour.copy()
    _measure_moves(observation, poses, contour)
    curve = observation.curve
    on_curve = _between(observation.times, curve.begin + LONGEST_LAG, curve.begin + curve.duration)
    dense = _stacked([curve.pose_at(t) for t in np.arange(0.0, curve.duration, 0.005)])
    contour[on_curve] = _distance_to_polyline(poses.position[on_curve], dense.position)
    lag = _lag(observation, poses.position, on_curve)
    commanded = [curve.pose_at(t - curve.begin - lag) for t in observation.times[on_curve]]
    turns = so3.log(np.swapaxes(poses.rotation[on_curve], -1, -2) @ _stacked(commanded).rotation)
    orientation[on_curve] = np.linalg.norm(turns, axis=-1)
    return Result(observation, poses, contour, lag, orientation)


def _measure_moves(observation: Observation, poses: Pose, contour: Array) -> None:
    start = poses.position[0]
    ends = [t for t, _ in observation.corners[1:]] + [observation.curve.begin]
    for (begin, goal), end in zip(observation.corners, ends, strict=True):
        during = _between(observation.times, begin, end)
        line = np.stack([start, goal.position])
        contour[during] = _distance_to_polyline(poses.position[during], line)
        start = goal.position


def _lag(observation: Observation, positions: Array, chosen: Mask) -> float:
    """The delay at which the positions come closest to the curve."""
    times, curve = observation.times[chosen] - observation.curve.begin, observation.curve
    grid = np.arange(-LONGEST_LAG, curve.duration + LAG_STEP, LAG_STEP)
    commanded = _stacked([curve.pose_at(t) for t in grid]).position
    lags = np.arange(0.0, LONGEST_LAG, LAG_STEP)
    indices = np.round((times[None, :] - lags[:, None] - grid[0]) / LAG_STEP).astype(int)
    errors = np.linalg.norm(positions[chosen] - commanded[indices.clip(0, len(grid) - 1)], axis=-1)
    return float(lags[np.argmin((errors**2).mean(axis=-1))])


def _poses(joints: Array, kinematics: Kinematics) -> Pose:
    found: list[Pose] = []
    for row in joints:
        found.append(kinematics.forward(row, found[-1] if found else None).pose)
    return _stacked(found)


def _stacked(poses: list[Pose]) -> Pose:
    return Pose(np.stack([p.position for p in poses]), np.stack([p.rotation for p in poses]))


def _distance_to_polyline(points: Array, corners: Array) -> Array:
    """The distance of each point (n, 3) from the nearest place on the line through the corners."""
    a, d = corners[:-1], np.diff(corners, axis=0)
    length = np.maximum(np.einsum('ij,ij->i', d, d), 1e-18)
    along = np.einsum('nij,ij->ni', points[:, None] - a, d) / length
    nearest = a + along.clip(0.0, 1.0)[..., None] * d
    distance: Array = np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1)
    return distance


def _between(times: Array, begin: float, end: float) -> Mask:
    inside: Mask = (times >= begin) & (times < end)
    return inside


def _rms(values: Array) -> float:
    return float(np.sqrt((values**2).mean()))
