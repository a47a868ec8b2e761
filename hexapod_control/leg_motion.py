"""The motion of a platform whose legs all move linearly: Lapikov et al. 2014, section 4.

Their Euler angles are R = Rz(α)·Rx(β)·Rz(γ).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hexapod_control.leg_jacobian import rods
from hexapod_control.linear_geometry import LinearGeometry
from manipulator import rotation as so3
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput, Unreachable
from manipulator.pose import Pose

LEAST_SINE = 1e-6


def to_zxz(rotations: ArrayLike, start: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """α, β, γ in radians of successive rotation matrices (n, 3, 3): (n, 3), continuous.

    Of the solutions of section 4, (α, β, γ), (α + π, −β, γ + π) and whole turns more, each sample
    gets the nearest to the last sample's, the first the nearest to `start`: the paper solves from
    the last solution. Where sin β < 1e-6 only α ± γ is fixed; there α stays.
    """
    angles, last = [], np.asarray(start, dtype=np.float64)
    for m in np.asarray(rotations, dtype=np.float64):
        candidates = np.array(_zxz_solutions(m, float(last[0])))
        candidates -= 2 * np.pi * np.round((candidates - last) / (2 * np.pi))
        last = candidates[np.argmin(np.abs(candidates - last).sum(axis=1))]
        angles.append(last)
    return np.array(angles)


def _zxz_solutions(m: Array, alpha: float) -> list[tuple[float, float, float]]:
    """Solutions within a turn, of a matrix (3, 3); of those of a level one that with `alpha`."""
    sine = float(np.hypot(m[0, 2], m[1, 2]))
    if sine < LEAST_SINE:
        turn = float(np.arctan2(m[1, 0], m[0, 0]))
        return [(alpha, 0.0, turn - alpha)] if m[2, 2] > 0 else [(alpha, np.pi, alpha - turn)]
    first, last = float(np.arctan2(m[0, 2], -m[1, 2])), float(np.arctan2(m[2, 0], m[2, 1]))
    beta = float(np.arctan2(sine, m[2, 2]))
    return [(first, beta, last), (first + np.pi, -beta, last + np.pi)]


Solver = Callable[[Array, Pose], Pose]
"""From leg lengths (6,) in metres and a pose nearby to the pose."""

PAPER_LENGTH = 0.150
PAPER_TARGET = (0.020, 0.020, 0.200)


@dataclass(frozen=True, eq=False)
class LegMotion:
    """Steps 0 … n of a motion: lengths (n + 1, 6) in metres, and as many poses."""

    lengths: Array
    poses: Pose

    @property
    def share(self) -> Array:
        """The part of the way done at each step, 0 … 1."""
        return frozen(np.linspace(0.0, 1.0, len(self.lengths)))

    @property
    def euler_zxz(self) -> Array:
        """α, β, γ (n + 1, 3) in radians, continuous, from about zero on."""
        return frozen(to_zxz(self.poses.rotation))

    @property
    def rotation_vectors(self) -> Array:
        """The orientations as rotation vectors (n + 1, 3) in radians, unique unlike the angles."""
        return so3.log(self.poses.rotation)

    @property
    def straight(self) -> Pose:
        """The poses along a straight line, with a turn about one axis, both even in time."""
        first, last = self.poses[0], self.poses[-1]
        return first.moved(self.share[:, None] * first.twist_to(last))

    @property
    def position_deviation(self) -> Array:
        """How far each position lies from the straight motion's at that step, metres."""
        return np.asarray(np.linalg.norm(self.straight.twist_to(self.poses)[:, :3], axis=1))

    @property
    def angle_deviation(self) -> Array:
        """By what angle each orientation differs from the straight motion's, radians."""
        return np.asarray(np.linalg.norm(self.straight.twist_to(self.poses)[:, 3:], axis=1))


def leg_motion(solve: Solver, first: Array, last: Array, start: Pose, steps: int) -> LegMotion:
    """Leg lengths from `first` to `last`, (6,) metres, linearly in equal steps.

    Each step's forward solution starts from the last one's, so that the small steps keep the
    assembly mode of `start`. Raises InvalidInput for steps < 1, NoSolution from the solver.
    """
    if steps < 1:
        raise InvalidInput(f'{steps} steps, a motion needs at least 1')
    lengths = np.linspace(first, last, steps + 1)
    poses = []
    pose = start
    for now in lengths:
        pose = solve(now, pose)
        poses.append(pose)
    joined = Pose(np.stack([p.position for p in poses]), np.stack([p.rotation for p in poses]))
    return LegMotion(frozen(lengths), joined)


def paper_motion(geometry: LinearGeometry, solve: Solver, steps: int = 100) -> LegMotion:
    """The experiment of section 4: level with all legs 150 mm, to (20, 20, 200) mm unturned.

    With the paper's own φb = φmp, a 6-6 geometry cannot even be built: see `check_architecture`.
    """
    start = level_pose(geometry, PAPER_LENGTH)
    target = Pose(np.array(PAPER_TARGET), np.eye(3))
    last = np.linalg.norm(rods(geometry.base_points, geometry.platform_points, target), axis=-1)
    return leg_motion(solve, np.full(6, PAPER_LENGTH), last, start, steps)


def level_pose(geometry: LinearGeometry, length: float) -> Pose:
    """The pose above the base, level and unturned, in which all legs have one length (metres).

    Raises Unreachable where the joints' circles do not allow it.
    """
    offset = geometry.platform_points - geometry.base_points
    across = np.hypot(offset[:, 0], offset[:, 1])
    if np.any(across >= length):
        leg = int(np.argmax(across >= length))
        message = f'leg {leg + 1}: length {length:.4g} m not above {across[leg]:.4g} m'
        raise Unreachable(message, leg + 1)
    heights = np.sqrt(length**2 - across**2) - offset[:, 2]
    if np.ptp(heights) > 1e-9 * length:
        raise Unreachable('no level pose has six equal leg lengths')
    return Pose(np.array([0.0, 0.0, float(heights[0])]), np.eye(3))
