"""What a `Robot` takes and returns: poses as programs have them, limits, the share of a move."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns

PoseLike = Pose | ArrayLike
"""A Pose; or x, y, z (m), or x, y, z, roll, pitch, yaw (m, rad); or a 4 × 4 matrix."""

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
        return value
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f'not a pose: {error}') from error
    if numbers.shape == (4, 4):
        return Pose(numbers[:3, 3], numbers[:3, :3])
    if numbers.shape not in ((3,), (6,)):
        raise InvalidInput(
            f'a pose is 3 or 6 numbers (x, y, z, roll, pitch, yaw), a 4 × 4 matrix or a Pose, '
            f'not an array of shape {numbers.shape}'
        )
    turns = numbers[3:] if len(numbers) == 6 else np.zeros(3)
    check_turns(turns.tolist())
    return Pose.from_xyz_rpy(numbers[:3], turns)


def poses_from(values: Pose | Iterable[PoseLike]) -> Pose:
    """Poses (n,), n ≥ 1."""
    if isinstance(values, Pose):
        return values if values.position.ndim == 2 else values[None]
    poses = [pose_from(value) for value in values]
    if not poses:
        raise InvalidInput('a path without poses')
    return Pose(np.stack([p.position for p in poses]), np.stack([p.rotation for p in poses]))


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
        raise InvalidInput(f'{name}: {value!r} is not a finite number{needs}')
    return number


def numbers_by_name(
    first: Mapping[str, float] | None, named: Mapping[str, float], what: str
) -> dict[str, float]:
    """Finite numbers of a mapping and of keywords; InvalidInput where none is given."""
    numbers = {name: checked(name, value) for name, value in {**(first or {}), **named}.items()}
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
