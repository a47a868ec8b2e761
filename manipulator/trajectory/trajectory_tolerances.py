"""How far the joints may be from a trajectory, by the request of FollowJointTrajectory."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.planning.joint_points import InvalidJoints

DEFAULT_GOAL_TIME = 1.0
"""Seconds after its end in which a trajectory's goal tolerances must be kept, by default."""


class JointTolerance(NamedTuple):
    """As control_msgs has it, in rad or m, and by s: 0 is the machine's own, negative is none."""

    name: str
    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0


@dataclass(frozen=True, eq=False)
class TrajectoryTolerances:
    """path, goal (n,): rad or m from the desired joints, infinite where nothing is requested.

    goal_speed (n,): rad/s or m/s at the end. goal_time: seconds after the end within which `goal`
    and `goal_speed` must be kept.
    """

    names: tuple[str, ...]
    unit: str
    path: Array
    goal: Array
    goal_speed: Array
    goal_time: float = DEFAULT_GOAL_TIME

    @classmethod
    def of(
        cls,
        machine: Machine,
        path: Sequence[JointTolerance],
        goal: Sequence[JointTolerance],
        goal_time: float,
    ) -> 'TrajectoryTolerances':
        """By the names of joints.

        Raises InvalidJoints for unknown joints, InvalidInput for numbers that are not finite and
        for what is not measured: speeds on the path, and accelerations.
        """
        names, unit = machine.kinematics.joint_names, machine.kinematics.joint_unit
        for given, what in ((path, 'path_tolerance'), (goal, 'goal_tolerance')):
            _check(names, given, what)
        for one in path:
            _check_none(one.velocity, f'velocity in path_tolerance of {one.name}')
        on_path = _row(names, [(one.name, one.position) for one in path])
        at_goal = _row(names, [(one.name, one.position) for one in goal])
        speed = _row(names, [(one.name, one.velocity) for one in goal])
        time = goal_time if goal_time > 0.0 else DEFAULT_GOAL_TIME
        return cls(names, unit, on_path, at_goal, speed, time)

    def path_violation(self, desired: Array, actual: Array) -> str:
        """The joint that is farthest beyond its tolerance on the path, in words; '' where none."""
        return self._violation(self.path, desired - actual, 'is {} from the trajectory', self.unit)

    def goal_violation(self, desired: Array, actual: Array, speed: Array) -> str:
        """As `path_violation`, at the end; speed (n,) in rad/s or m/s, NaN while it is unknown."""
        unit = f'{self.unit}/s'
        return self._violation(
            self.goal, desired - actual, 'is {} from the trajectory', self.unit
        ) or self._violation(self.goal_speed, speed, 'still moves at {}', unit)

    def _violation(self, tolerance: Array, error: Array, words: str, unit: str) -> str:
        beyond = np.where(np.isfinite(tolerance), np.abs(error) - tolerance, -np.inf)
        if (beyond <= 0.0).all():
            return ''
        k = int(np.argmax(beyond))
        how = words.format(f'{abs(error[k]):.4g} {unit}')
        return f'{self.names[k]} {how}, its tolerance is {tolerance[k]:.4g} {unit}'


def _check(names: tuple[str, ...], given: Sequence[JointTolerance], what: str) -> None:
    for name, *numbers in given:
        if name not in names:
            raise InvalidJoints(f'{what}: joint {name[:80]!r} is unknown')
        if not np.isfinite(numbers).all():
            raise InvalidInput(f'{what} of {name} is {numbers}, needs finite numbers')
        _check_none(numbers[-1], f'acceleration in {what} of {name}')


def _check_none(value: float, what: str) -> None:
    if value > 0.0:
        raise InvalidInput(f'{what} is {value:.4g}: it is not measured, needs 0 or less')


def _row(names: tuple[str, ...], given: Sequence[tuple[str, float]]) -> Array:
    row = np.full(len(names), np.inf)
    for name, value in given:
        if value > 0.0:
            row[names.index(name)] = value
    return frozen(row)
