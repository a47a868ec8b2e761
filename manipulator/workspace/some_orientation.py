"""Positions that a machine reaches with at least one orientation: docs/workspace.md, section 3."""

from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.reach.readings import readings_of
from manipulator.reach.way import keeps_limits
from manipulator.workspace.volume import Box

STARTS = 40
SEED = 7
LAST_SPREAD = 0.03


@dataclass(frozen=True)
class SomeOrientation:
    """The positions admitted with some roll, pitch and yaw, each within ±largest (rad).

    First a few orientations are tried on all positions, then, where none was admitted, `steps`
    random changes of the best one so far, ever smaller. What is found is admitted for certain;
    what is not found may be admitted all the same.
    """

    machine: Machine
    largest: float
    steps: int = 60

    def __call__(self, positions: Array) -> Mask:
        """Which positions (N, 3) in metres were found."""
        found = np.zeros(len(positions), dtype=np.bool_)
        best = np.full(len(positions), -np.inf)
        angles = np.zeros((len(positions), 3))
        cube = Box(np.full(3, -self.largest), np.full(3, self.largest))
        for start in np.vstack([np.zeros(3), cube.lattice(STARTS, np.zeros(3))]):
            self._try(positions, np.tile(start, (len(positions), 1)), found, best, angles)
        generator = np.random.default_rng(SEED)
        for spread in self.largest * np.geomspace(0.6, LAST_SPREAD, self.steps):
            changed = angles + spread * generator.standard_normal(angles.shape)
            self._try(positions, changed.clip(cube.low, cube.high), found, best, angles)
        return found

    def _try(
        self, positions: Array, trial: Array, found: Mask, best: Array, angles: Array
    ) -> None:
        """Notes in the last three what the trial angles (N, 3) better."""
        rest = np.flatnonzero(~found)
        pose = Pose(positions[rest], so3.from_rpy(trial[rest]))
        joints = self.machine.kinematics.inverse_or_nan(pose)
        inside = keeps_limits(self.machine, pose, joints)
        found[rest[inside]] = True
        rest, pose = rest[~inside], pose[~inside]
        score = self._score(pose, joints[~inside])
        better = score > best[rest]
        best[rest[better]] = score[better]
        angles[rest[better]] = trial[rest[better]]

    def _score(self, pose: Pose, joints: Array) -> Array:
        """The worst margin that exists, metres by the characteristic length; (N,)."""
        readings = readings_of(self.machine, pose, joints)
        length = self.machine.kinematics.characteristic_length
        scales = np.array([length if unit == 'm' else 1.0 for _, _, unit in readings.names])
        margins = readings.margins / np.tile(scales, 2)
        worst: Array = np.nan_to_num(margins, nan=np.inf).min(axis=-1)
        return worst
