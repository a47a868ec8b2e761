"""A geometric path through given poses: straight between them, with small parabolic corners.

Between two poses the position goes along a line and the orientation about one fixed axis, both in
proportion to the path's parameter s. At each pose the rate changes from that of the segment
before to that of the segment after, evenly over s_i ± d_i: docs/motion.md, (4.1) to (4.3). So
the path has a continuous tangent and bounded curvature, is exactly straight elsewhere, and where
poses lie close together (d_i is then half a segment) it is a quadratic spline. Poses along simple
shapes are there to make paths of.
"""

from dataclasses import dataclass
from functools import cached_property
from math import acos, ceil

import numpy as np
from numpy.typing import ArrayLike

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.planning.plan import MotionState
from manipulator.planning.point_to_point import state_of
from manipulator.pose import Pose

REPEATED_SHARE = 0.1
"""Poses nearer to the one before than this part of the tolerance are repetitions of it."""


@dataclass(frozen=True)
class Tolerance:
    """How far a path may be from the straight lines between its poses."""

    distance: float = 1e-4
    turn: float = np.pi / 1800


@dataclass(frozen=True, eq=False)
class Path:
    """Poses (n,), n ≥ 2, with the parameter s, the half width d and the number of each (n,).

    The numbers are those by which the poses' sender knows them, from 1.
    """

    poses: Pose
    marks: Array
    blends: Array
    numbers: tuple[int, ...]

    @cached_property
    def rates(self) -> Array:
        """The twist per unit of s on each segment, (n − 1, 6)."""
        return self.poses[:-1].twist_to(self.poses[1:]) / np.diff(self.marks)[:, None]

    @cached_property
    def _metres(self) -> Array:
        steps = np.linalg.norm(np.diff(self.poses.position, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def at(self, s: Array | float) -> MotionState:
        """Pose, d(pose)/ds and d²(pose)/ds² as the state's twist and acceleration, s (...)."""
        parameter = np.clip(np.asarray(s, dtype=np.float64), self.marks[0], self.marks[-1])
        corner = np.searchsorted((self.marks[1:] + self.marks[:-1]) / 2, parameter)
        t = parameter - self.marks[corner]
        before = self.rates[np.maximum(corner - 1, 0)]
        after = self.rates[np.minimum(corner, len(self.rates) - 1)]
        ramp, slope, bend = (r[..., None] for r in _ramp(t, self.blends[corner]))
        x = before * t[..., None] + (after - before) * ramp
        x[..., :3] += self.poses.position[corner]
        rate, curvature = before + (after - before) * slope, (after - before) * bend
        return state_of(x, rate, curvature, self.poses.rotation[corner])

    def metres(self, s: float) -> float:
        """The path length to s, from pose to pose."""
        return float(np.interp(s, self.marks, self._metres))

    def where(self, s: float) -> str:
        """In words, as 'at pose 17, 0.0123 m along the path'."""
        last = int(np.searchsorted(self.marks, s, side='right')) - 1
        is_there = np.isclose(self.marks[last], s)
        word = 'at' if is_there or last == len(self.numbers) - 1 else 'after'
        return f'{word} pose {self.numbers[last]}, {self.metres(s):.4g} m along the path'


def path_along(
    poses: Pose,
    tolerance: Tolerance,
    turn_length: float,
    numbers: tuple[int, ...] | None = None,
) -> Path | Pose:
    """The path whose parameter is its length in metres, or the one pose that all `poses` are.

    A segment is as long as its positions are apart, or as turn_length (m/rad) makes of its turn
    where that is more: so a machine's fastest turn takes as long as its fastest shift.
    """
    kept = _without_repetitions(poses, tolerance)
    if len(kept) == 1:
        return poses[kept[0]]
    distinct = poses[kept]
    steps = distinct[:-1].twist_to(distinct[1:])
    shifts, turns = np.linalg.norm(steps[:, :3], axis=1), np.linalg.norm(steps[:, 3:], axis=1)
    spans = np.maximum(shifts, turn_length * turns)
    marks = np.concatenate([[0.0], np.cumsum(spans)])
    share = 1.0 - REPEATED_SHARE
    left = Tolerance(share * tolerance.distance, share * tolerance.turn)
    known = numbers or range(1, len(poses.position) + 1)
    return _blended(distinct, marks, left, tuple(known[k] for k in kept))


def path_in_time(
    poses: Pose, stamps: Array, tolerance: Tolerance, numbers: tuple[int, ...] | None = None
) -> Path:
    """The path whose parameter is time: at each pose at its stamp (s, strictly increasing)."""
    known = numbers or tuple(range(1, len(stamps) + 1))
    return _blended(poses, stamps - stamps[0], tolerance, known)


def _blended(poses: Pose, marks: Array, tolerance: Tolerance, numbers: tuple[int, ...]) -> Path:
    """Corners as wide as tolerance and segments allow: the path misses pose i by d·|Δrate|/4."""
    path = Path(poses, marks, np.zeros(len(marks)), numbers)
    spans = np.diff(marks)
    width = np.minimum(spans[:-1], spans[1:]) / 2
    change = np.diff(path.rates, axis=0)
    for part, allowed in ((slice(0, 3), tolerance.distance), (slice(3, 6), tolerance.turn)):
        size = np.linalg.norm(change[:, part], axis=1)
        width = np.minimum(width, 4 * allowed / np.maximum(size, 1e-12))
    return Path(poses, marks, np.concatenate([[0.0], width, [0.0]]), numbers)


def _ramp(t: Array, d: Array) -> tuple[Array, Array, Array]:
    """0 before −d, t after d, (t + d)²/4d between; and its two derivatives."""
    safe = np.maximum(d, 1e-300)
    is_blend = np.abs(t) < d
    slope = np.where(is_blend, (t + d) / (2 * safe), np.where(t < 0, 0.0, 1.0))
    ramp = np.where(is_blend, (t + d) * slope / 2, np.maximum(t, 0.0))
    return ramp, slope, is_blend / (2 * safe)


def _without_repetitions(poses: Pose, tolerance: Tolerance) -> list[int]:
    """The first pose, then each that differs from the last one kept; the end is always kept."""
    kept = [0]
    for i in range(1, len(poses.position)):
        last = kept[-1]
        shift = np.linalg.norm(poses.position[i] - poses.position[last])
        turn = np.linalg.norm(poses.rotation[i] - poses.rotation[last]) / np.sqrt(2)
        near = REPEATED_SHARE * tolerance.distance, REPEATED_SHARE * tolerance.turn
        if shift > near[0] or turn > near[1]:
            kept.append(i)
    if len(kept) > 1:
        kept[-1] = len(poses.position) - 1
    return kept


MOST_POSES = 2000


def line(start: Pose, goal: Pose) -> Pose:
    """The two ends of a segment, (2,)."""
    return Pose(
        np.stack([start.position, goal.position]), np.stack([start.rotation, goal.rotation])
    )


def arc(
    start: Pose,
    centre: ArrayLike,
    axis: ArrayLike,
    angle: float,
    is_turning: bool = False,
    sagitta: float = 1e-5,
) -> Pose:
    """From `start` about the axis through `centre` (m) by `angle` (rad, any number of turns).

    The orientation stays, or turns along where is_turning. Poses (n,) lie so close that the
    chords between them are within `sagitta` (m) of the arc. Raises InvalidInput for an axis
    without direction and for arcs that need more than 2,000 poses.
    """
    direction, middle = (np.asarray(v, dtype=np.float64) for v in (axis, centre))
    length = float(np.linalg.norm(direction))
    if not (length > 0 and np.isfinite(direction).all() and np.isfinite([angle, *middle]).all()):
        raise InvalidInput(f'arc about {middle.tolist()}, axis {direction.tolist()}, {angle} rad')
    arm = start.position - middle
    radius = float(np.linalg.norm(np.cross(direction / length, arm)))
    step = 2 * acos(max(1.0 - sagitta / max(radius, sagitta), 0.0))
    count = max(ceil(abs(angle) / step), 2) + 1
    if count > MOST_POSES:
        raise InvalidInput(f'an arc of {count} poses, at most {MOST_POSES}: allow more sagitta')
    turns = so3.exp(np.linspace(0.0, angle, count)[:, None] * direction / length)
    rotation = turns @ start.rotation if is_turning else start.rotation
    return Pose(middle + turns @ arm, rotation)
