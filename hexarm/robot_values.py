"""What a `Robot` takes and returns: poses as programs have them, limits, the share of a move."""

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import shown
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns

PoseLike = Pose | ArrayLike
"""A Pose; or x, y, z (m), or x, y, z, roll, pitch, yaw (m, rad); or a 4 × 4 matrix."""

MOST_POSES = 2000
"""Of a path: as many as a message holds."""
ROUNDING = 1e-4
"""Of the numbers of a matrix, which may be single precision."""
FileName = str | os.PathLike[str]
COORDINATES = ('x', 'y', 'z', 'roll', 'pitch', 'yaw')


@dataclass(frozen=True)
class Limits:
    """Of a machine: each joint's unit ('rad', 'm'), range and speed, the platform's speeds."""

    units: Mapping[str, str]
    joints: Mapping[str, tuple[float, float]]
    joint_speeds: Mapping[str, float]
    speed: float
    turning_speed: float

    @classmethod
    def of(cls, machine: Machine) -> 'Limits':
        """From a machine file."""
        names = machine.kinematics.joint_names
        low, high = (bounds.tolist() for bounds in machine.joint_ranges)
        speeds = np.broadcast_to(machine.motion.joint.speed, len(names)).tolist()
        return cls(
            dict.fromkeys(names, machine.kinematics.joint_unit),
            dict(zip(names, zip(low, high, strict=True), strict=True)),
            dict(zip(names, speeds, strict=True)),
            machine.motion.linear.speed,
            machine.motion.angular.speed,
        )


def pose_from(value: PoseLike) -> Pose:
    """One pose; InvalidInput for what is none, and for angles that are degrees."""
    if isinstance(value, Pose):
        if value.position.ndim != 1:
            raise InvalidInput(f'needs one pose, not {len(value.position)}: see `follow`')
        return value
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f'not a pose: {error}') from error
    if numbers.shape == (4, 4):
        return _pose_of_matrix(numbers)
    if numbers.shape not in ((3,), (6,)):
        raise InvalidInput(
            f'a pose is 3 or 6 numbers (x, y, z, roll, pitch, yaw), a 4 × 4 matrix or a Pose, '
            f'not an array of shape {numbers.shape}'
        )
    turns = numbers[3:] if len(numbers) == 6 else np.zeros(3)
    check_turns(turns.tolist())
    return Pose.from_xyz_rpy(numbers[:3], turns)


def _pose_of_matrix(matrix: Array) -> Pose:
    """Of a homogeneous transform (4, 4)."""
    pose = Pose(matrix[:3, 3], matrix[:3, :3])
    away = np.abs(pose.rotation @ pose.rotation.T - np.eye(3)).max()
    if away > ROUNDING or np.linalg.det(pose.rotation) < 0.0:
        raise InvalidInput('the first three rows and columns of the matrix are not a rotation')
    if np.abs(matrix[3] - [0.0, 0.0, 0.0, 1.0]).max() > ROUNDING:
        raise InvalidInput(f'the last row of the matrix is {matrix[3].tolist()}, needs 0, 0, 0, 1')
    return pose


def poses_from(values: Pose | Iterable[PoseLike]) -> Pose:
    """Poses (n,), n ≥ 1."""
    if isinstance(values, Pose):
        path = values if values.position.ndim == 2 else values[None]
        _check_length(len(path.position))
        return path
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InvalidInput(f'a path is a list of poses, not {shown(values)}')
    poses = [pose_from(value) for value in islice(values, MOST_POSES + 1)]
    _check_length(len(poses))
    return Pose(np.stack([p.position for p in poses]), np.stack([p.rotation for p in poses]))


def _check_length(count: int) -> None:
    if not 1 <= count <= MOST_POSES:
        found = 'with more' if count > MOST_POSES else 'without poses'
        raise InvalidInput(f'a path {found}, needs 1 to {MOST_POSES:,}')


def moved_to(pose: Pose, named: Mapping[str, float | None]) -> Pose:
    """The pose with some of its COORDINATES replaced; None keeps one."""
    numbers = [*pose.position.tolist(), *pose.rpy.tolist()]
    for i, name in enumerate(COORDINATES):
        value = named.get(name)
        if value is not None:
            numbers[i] = checked(name, value)
    return pose_from(numbers)


def checked(name: str, value: Any, above: float = -math.inf, least: float = -math.inf) -> float:
    """A finite number, above or at least another one; InvalidInput names it."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not (math.isfinite(number) and number > above and number >= least):
        needs = '' if above == -math.inf else f' above {above:g}'
        needs += '' if least == -math.inf else f' of at least {least:g}'
        raise InvalidInput(f'{name}: {shown(value)} is not a finite number{needs}')
    return number


def check_progress(progress: object) -> None:
    """InvalidInput for what is no function."""
    if progress is not None and not callable(progress):
        raise InvalidInput(f'progress: {shown(progress)} is not a function of one number')


def checked_file(name: object) -> str:
    """The name or the path of a machine file; InvalidInput for what is neither."""
    if not isinstance(name, str | os.PathLike):
        raise InvalidInput(f'machine: {shown(name)} is neither a name nor a path')
    return str(name)


def numbers_by_name(
    first: Mapping[str, float] | None, named: Mapping[str, float], what: str
) -> dict[str, float]:
    """Finite numbers of a mapping and of keywords; InvalidInput where none is given."""
    if first is not None and not isinstance(first, Mapping):
        raise InvalidInput(f'needs a number for each {what} by name, not {shown(first)}')
    numbers = {}
    for name, value in {**(first or {}), **named}.items():
        if not isinstance(name, str):
            raise InvalidInput(f'{shown(name)} is not the name of a {what}')
        numbers[name] = checked(name, value)
    if not numbers:
        raise InvalidInput(f'no {what} is named')
    return numbers


def share_done(start: Pose, here: Pose, goal: Pose) -> float:
    """How much of a move from start to goal is done, 0 to 1; by its shift or turn."""
    way, left = start.twist_to(goal), here.twist_to(goal)
    shares = [
        np.linalg.norm(left[part]) / length
        for part in (slice(3), slice(3, 6))
        if (length := np.linalg.norm(way[part])) > 1e-9
    ]
    return float(np.clip(1.0 - max(shares, default=0.0), 0.0, 1.0))
