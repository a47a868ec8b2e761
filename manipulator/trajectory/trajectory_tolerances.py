"""How far the joints may be from a trajectory, by the request of FollowJointTrajectory."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.planning.joint_points import InvalidJoints

DEFAULT_GOAL_TIME = 1.0
"""Seconds after its end in which a trajectory's goal tolerances must be kept, by default."""


@dataclass(frozen=True, eq=False)
class TrajectoryTolerances:
    """path, goal (n,): rad or m from the desired joints, infinite where nothing is requested.

    goal_time: seconds after the end within which `goal` must be kept.
    """

    names: tuple[str, ...]
    unit: str
    path: Array
    goal: Array
    goal_time: float = DEFAULT_GOAL_TIME

    @classmethod
    def of(
        cls,
        machine: Machine,
        path: Sequence[tuple[str, float]],
        goal: Sequence[tuple[str, float]],
        goal_time: float,
    ) -> 'TrajectoryTolerances':
        """From names and positions: 0 is the machine's own tolerance, negative is none.

        Raises InvalidJoints for unknown joints, InvalidInput for numbers that are not finite.
        """
        names, unit = machine.kinematics.joint_names, machine.kinematics.joint_unit
        on_path, at_goal = _row(names, path, 'path_tolerance'), _row(names, goal, 'goal_tolerance')
        time = goal_time if goal_time > 0.0 else DEFAULT_GOAL_TIME
        return cls(names, unit, on_path, at_goal, time)

    def path_violation(self, desired: Array, actual: Array) -> str:
        """The joint that is farthest beyond its tolerance on the path, in words; '' where none."""
        return self._violation(self.path, desired, actual)

    def goal_violation(self, desired: Array, actual: Array) -> str:
        """As `path_violation`, at the end."""
        return self._violation(self.goal, desired, actual)

    def _violation(self, tolerance: Array, desired: Array, actual: Array) -> str:
        away = np.abs(desired - actual)
        k = int(np.argmax(away - tolerance))
        if away[k] <= tolerance[k]:
            return ''
        unit = self.unit
        return (
            f'{self.names[k]} is {away[k]:.4g} {unit} from the trajectory, '
            f'its tolerance is {tolerance[k]:.4g} {unit}'
        )


def _row(names: tuple[str, ...], given: Sequence[tuple[str, float]], what: str) -> Array:
    row = np.full(len(names), np.inf)
    for name, position in given:
        if name not in names:
            raise InvalidJoints(f'{what}: joint {name[:80]!r} is unknown')
        if not np.isfinite(position):
            raise InvalidInput(f'{what} of {name} is {position}, needs a finite number')
        if position > 0.0:
            row[names.index(name)] = position
    return frozen(row)
