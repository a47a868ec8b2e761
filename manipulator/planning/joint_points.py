"""The points of a joint trajectory, by the rules of ros2_controllers' joint_trajectory_controller.

Names of all joints of the machine, in any order, and for each point a time, positions, and perhaps
velocities and accelerations.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.formatting import counted, shown

MOST_POINTS = 2000

AT_REST = 1e-3
"""rad/s or m/s that count as rest, at the ends of a trajectory."""


class InvalidJoints(InvalidInput):
    """Joints that are missing, unknown, or named twice."""


@dataclass(frozen=True)
class JointPoint:
    """One point as it was sent: time (s) from the trajectory's start, one number a joint.

    velocities, accelerations and effort may be empty.
    """

    time: float
    positions: Sequence[float]
    velocities: Sequence[float] = ()
    accelerations: Sequence[float] = ()
    effort: Sequence[float] = ()


@dataclass(frozen=True, eq=False)
class JointPoints:
    """m points: times (m,) in s from the start, the others (m, n) in rad or m, for each joint.

    numbers (m,): those by which their sender knows the points, from 1. velocities: None where none
    are given; rows of `accelerations` are NaN where none are.
    """

    numbers: tuple[int, ...]
    times: Array
    positions: Array
    velocities: Array | None
    accelerations: Array

    def after(self, time: float) -> 'JointPoints':
        """The points later than `time`, with the times from then; InvalidInput where none is."""
        is_later = self.times > time if time > 0.0 else np.ones(len(self.times), dtype=np.bool_)
        if not is_later.any():
            ago = time - float(self.times[-1])
            raise InvalidInput(f'the trajectory ended {ago:.3f} s ago, by its stamps')
        first = int(np.argmax(is_later))
        velocities = None if self.velocities is None else self.velocities[first:]
        return JointPoints(
            self.numbers[first:],
            self.times[first:] - time,
            self.positions[first:],
            velocities,
            self.accelerations[first:],
        )


def joint_points(
    names: Sequence[str], points: Sequence[JointPoint], known: Sequence[str]
) -> JointPoints:
    """Points as they were sent, checked; `known` are the machine's joints.

    Raises InvalidJoints for joints that are missing, unknown or named twice, and InvalidInput,
    naming the point, for numbers that are missing, too many or not finite, for times that do not
    increase, and for a motion that does not end at rest.
    """
    check_all_named(names, known)
    if not 1 <= len(points) <= MOST_POINTS:
        count = counted(len(points), 'point')
        raise InvalidInput(f'a trajectory of {count}, needs 1 to {MOST_POINTS:,}')
    times = _times(points)
    positions = _rows(names, points, 'positions')
    has_velocities = [len(point.velocities) > 0 for point in points]
    if any(has_velocities) and not all(has_velocities):
        missing = has_velocities.index(False) + 1
        raise InvalidInput(f'point {missing} has no velocities, others have: give all or none')
    velocities = _rows(names, points, 'velocities') if all(has_velocities) else None
    accelerations = _rows(names, points, 'accelerations', is_optional=True)
    for number, point in enumerate(points, start=1):
        if len(point.effort):
            raise InvalidInput(f'point {number}: effort is not supported')
    _check_ends(names, velocities)
    numbers, order = tuple(range(1, len(points) + 1)), [names.index(name) for name in known]
    velocities = None if velocities is None else velocities[:, order]
    return JointPoints(numbers, times, positions[:, order], velocities, accelerations[:, order])


def check_names(names: Sequence[str], known: Sequence[str]) -> None:
    """Raises InvalidJoints unless these are some of the known joints, each once."""
    if not names:
        raise InvalidJoints(f'no joint is named, needs some of {", ".join(known)}')
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InvalidJoints(f'joint {shown(unknown[0])} is unknown, needs {", ".join(known)}')
    twice = [name for name in known if list(names).count(name) > 1]
    if twice:
        raise InvalidJoints(f'joint {twice[0]} is named twice')


def check_all_named(names: Sequence[str], known: Sequence[str]) -> None:
    """Raises InvalidJoints unless these are the known joints, each once, in any order."""
    check_names(names, known)
    missing = [name for name in known if name not in names]
    if missing:
        raise InvalidJoints(f'joint {missing[0]} is missing, needs all of {", ".join(known)}')


def _times(points: Sequence[JointPoint]) -> Array:
    times = np.array([point.time for point in points])
    if not np.isfinite(times).all() or times[0] < 0.0:
        raise InvalidInput(f'point 1: time_from_start is {times[0]:g} s, needs at least 0')
    back = np.flatnonzero(np.diff(times) <= 0.0)
    if back.size:
        i = int(back[0])
        raise InvalidInput(
            f'point {i + 2}: time_from_start is {times[i + 1]:g} s, that of the point before '
            f'{times[i]:g} s: it must increase'
        )
    return frozen(times)


def _rows(
    names: Sequence[str], points: Sequence[JointPoint], what: str, is_optional: bool = False
) -> Array:
    """One row a point; NaN for an optional one that is empty."""
    rows = np.full((len(points), len(names)), np.nan)
    for i, point in enumerate(points):
        values = getattr(point, what)
        if is_optional and not len(values):
            continue
        if len(values) != len(names):
            count, joints = counted(len(values), 'number'), counted(len(names), 'joint')
            raise InvalidInput(f'point {i + 1}: {count} in {what} for {joints}')
        rows[i] = values
        if not np.isfinite(rows[i]).all():
            wrong = int(np.argmin(np.isfinite(rows[i])))
            raise InvalidInput(
                f'point {i + 1}: {what} of {names[wrong]} is {rows[i, wrong]}, '
                'needs a finite number'
            )
    return frozen(rows)


def _check_ends(names: Sequence[str], velocities: Array | None) -> None:
    if velocities is None:
        return
    moving = np.abs(velocities[-1]) > AT_REST
    if moving.any():
        k = int(np.argmax(moving))
        raise InvalidInput(
            f'the last point: velocity of {names[k]} is {velocities[-1, k]:g}, needs 0'
        )
