"""How far a machine can go along a twist."""

from dataclasses import dataclass

import numpy as np

from manipulator.analysis.free_paths import admits, is_by_joints, last_free
from manipulator.analysis.readings import CHECKS_PER_LENGTH, displaced, scale
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, Unreachable
from manipulator.machine import Machine
from manipulator.pose import Pose

LONGEST = 100  # characteristic lengths, after which nothing more is expected
LARGEST_TURN = np.pi
CHUNK = 256
BEYOND = 1e-6


@dataclass(frozen=True, eq=False)
class Travel:
    """The travel left along a twist.

    seconds at that twist, metres of path (rotations scaled by the characteristic length), the
    last pose, and why it goes no further ('' where no limit was met within half a turn and 100
    characteristic lengths).
    """

    seconds: float
    metres: float
    pose: Pose
    reason: str


def travel(machine: Machine, pose: Pose, twist: Array, near: Array | None = None) -> Travel:
    """How far `pose` can go along a twist (6,): the position straight, turning about one axis.

    Zero where the pose itself is out of reach. Arms follow the branch of `near`. Raises
    InvalidInput for a twist that is zero or not finite.
    """
    given = np.asarray(twist, dtype=np.float64)
    if given.shape != (6,) or not np.isfinite(given).all() or not given.any():
        raise InvalidInput(f'twist {given.tolist()} is not six finite numbers, not all 0')
    path = given * scale(machine)
    speed = float(np.linalg.norm(path))
    length = machine.kinematics.characteristic_length
    direction, step = path / speed, length / CHECKS_PER_LENGTH
    turn = float(np.linalg.norm(direction[3:])) / length
    longest = min(LONGEST * length, LARGEST_TURN / turn if turn > 0.0 else np.inf)
    free = _free_metres(machine, pose, direction, step, longest, _followed(machine, pose, near))
    end = displaced(machine, pose, free * direction)
    reason = ''
    if free < longest:
        beyond = displaced(machine, pose, (free + BEYOND * length) * direction)
        reason = _refusal(machine, beyond, near)
    return Travel(free / speed, free, end, reason)


def _refusal(machine: Machine, pose: Pose, near: Array | None) -> str:
    """Why a pose is out of reach."""
    try:
        machine.constraints.check(pose, machine.kinematics.inverse(pose, near))
    except Unreachable as error:
        return str(error)
    return ''


def _followed(machine: Machine, pose: Pose, near: Array | None) -> Array | None:
    """The joints to follow from: home's branch is the only one of a platform, and needs none."""
    if near is not None or not is_by_joints(machine):
        return near
    joints = machine.kinematics.inverse_or_nan(pose)
    return joints if np.isfinite(joints).all() else None


def _free_metres(
    machine: Machine, pose: Pose, path: Array, step: float, longest: float, near: Array | None
) -> float:
    """How far along `path` (6,), a unit vector, everything is admitted, at most `longest`."""
    for begin in np.arange(0.0, longest, CHUNK * step):
        metres = np.minimum(begin + step * np.arange(CHUNK + 1), longest)
        inside = admits(machine, displaced(machine, pose, metres[:, None] * path), near)
        if not inside.all():
            first = int(np.argmin(inside))
            if first == 0:
                return float(begin)
            return last_free(machine, pose, path, metres[first - 1], metres[first], near)
        if near is not None:
            near = machine.kinematics.inverse_along(
                displaced(machine, pose, metres[:, None] * path), near
            )[-1]
    return longest
