"""What ideal sensors showed in a simulated motion, on three axes, as columns of a table.

Prokopovich 2019 measures position, speed, acceleration and force of a body on three axes, and
speed and torque of each joint.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hexarm.simulation.experiment import Recording
from hexarm.simulation.rigid_body import RigidBody
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import reason

AXES = ('x', 'y', 'z')
DIGITS = 7


def carrying_force(recording: Recording, load: RigidBody) -> Array:
    """What holds and moves `load`, given in the moving frame: (N, 3) newtons, base axes.

    m (a − g), a the acceleration of its centre: what a force sensor below it shows.
    """
    arm = recording.poses.rotation @ load.centre
    turning, spin_up = recording.twists[:, 3:], recording.accelerations[:, 3:]
    inward = np.cross(turning, np.cross(turning, arm))
    centre = recording.accelerations[:, :3] + np.cross(spin_up, arm) + inward
    force: Array = load.mass * (centre - recording.gravity)
    return force


@dataclass(frozen=True, eq=False)
class Series:
    """Named columns (N,) of equal length, `time` first: SI units, radians, base axes."""

    columns: dict[str, Array]

    @classmethod
    def of(cls, recording: Recording, joints: tuple[str, ...], load: RigidBody) -> 'Series':
        """Of the platform or tool on three axes, the load's force, and each joint."""
        threes = {
            'position': recording.poses.position,
            'rotation': so3.log(recording.poses.rotation),
            'speed': recording.twists[:, :3],
            'turning': recording.twists[:, 3:],
            'acceleration': recording.accelerations[:, :3],
            'spin_up': recording.accelerations[:, 3:],
            'force': carrying_force(recording, load),
            'position_error': recording.errors[:, :3],
            'rotation_error': recording.errors[:, 3:],
        }
        each = {
            'joint': recording.joints,
            'joint_speed': recording.rates,
            'joint_effort': recording.efforts,
        }
        columns = {'time': recording.times}
        for names, groups in ((AXES, threes), (joints, each)):
            for group, values in groups.items():
                for k, name in enumerate(names):
                    columns[f'{group}_{name}'] = values[:, k]
        return cls(columns)

    def for_programs(self) -> dict[str, list[float]]:
        """Lists by name, rounded to seven digits."""
        return {name: [_rounded(v) for v in values] for name, values in self.columns.items()}

    def write_csv(self, path: Path) -> None:
        """A line for each sample; InvalidInput where it cannot be written."""
        try:
            with path.open('w', newline='', encoding='utf-8') as file:
                writer = csv.writer(file)
                writer.writerow(self.columns)
                for row in zip(*self.columns.values(), strict=True):
                    writer.writerow([f'{v:.{DIGITS}g}' for v in row])
        except OSError as error:
            raise InvalidInput(f'cannot write {path}: {reason(error)}') from error


def _rounded(value: float) -> float:
    return float(f'{value:.{DIGITS}g}')
