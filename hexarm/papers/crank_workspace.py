"""The volume of the workspace of Prokopovich 2019, like for like: fig. 8 b.

The paper's model has no limits but its geometry, and its volume is that of the positions that the
centre reaches, with rotations that the text does not state.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexarm import machines
from hexarm.papers.crank_kinematics import MACHINE, free
from hexarm.papers.finding import ROTARY, Claim, Finding, unstated
from manipulator import rotation as so3
from manipulator.analysis.volume import Volume, bounding_box, volume, with_orientation
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose

PAPER = 0.64
TEXT = '0.64 dm³'
RANGES = {
    'own': ('rotated within the paper’s own ranges', (0.20, 0.17, 0.20)),
    '0.3': ('rotated by up to 0.3 rad about each axis', (0.3, 0.3, 0.3)),
    '0.5': ('rotated by up to 0.5 rad about each axis', (0.5, 0.5, 0.5)),
}
STARTS, ITERATIONS = 8, 8
PILOT_STARTS, PILOT_ITERATIONS, PILOT = 2, 6, 8000
STEP, MARGIN, DAMPING = 1e-5, 2e-5, 1e-9
"""Of differences, rad; by how much legs are to close, m; of the normal equations."""
NEAR = 5 * MARGIN


@dataclass(frozen=True, eq=False)
class AnyOrientation:
    """The positions at which all legs close with some roll, pitch, yaw, each within ±largest (3,).

    From each of `starts` orientations, Gauss-Newton steps on the legs that do not close. What is
    found is certain; what is not found may exist.
    """

    machine: Machine
    largest: Array
    starts: int = STARTS
    iterations: int = ITERATIONS

    def __call__(self, positions: Array) -> Mask:
        """Which positions (N, 3) in metres were found."""
        generator = np.random.default_rng(7)
        found = np.zeros(len(positions), dtype=np.bool_)
        for start in range(self.starts):
            rest = np.flatnonzero(~found)
            spread = self.largest if start else 0 * self.largest
            angles = generator.uniform(-spread, spread, (len(rest), 3))
            for _ in range(self.iterations):
                closes = self._misfits(positions[rest], angles).max(axis=-1, initial=-np.inf) <= 0
                found[rest[closes]] = True
                rest, angles = rest[~closes], angles[~closes]
                angles = self._improved(positions[rest], angles)
        return found

    def _misfits(self, positions: Array, angles: Array) -> Array:
        """By how much each limit is missed (N, k), metres, negative where it is kept."""
        pose, no_joints = Pose(positions, so3.from_rpy(angles)), np.zeros((len(positions), 6))
        limits = self.machine.constraints
        values = limits.values(pose, no_joints)
        misfits: Array = np.maximum(values - limits.high, limits.low - values)
        return misfits

    def _improved(self, positions: Array, angles: Array) -> Array:
        misfit = self._misfits(positions, angles)
        slopes = np.stack(
            [(self._misfits(positions, angles + STEP * e) - misfit) / STEP for e in np.eye(3)],
            axis=-1,
        ) * (misfit > -NEAR)[..., None]  # fmt: skip
        wanted = np.where(misfit > -MARGIN, misfit + MARGIN, 0.0)
        across = np.swapaxes(slopes, -1, -2)
        normal = across @ slopes + DAMPING * np.eye(3)
        change = np.linalg.solve(normal, across @ wanted[..., None])[..., 0]
        return np.clip(angles - change, -self.largest, self.largest)


def level_volume(machine: Machine, points: int) -> Volume:
    """Of the positions at home's orientation, within the machine's limits."""
    home = machine.kinematics.home
    reached = with_orientation(machine, home.rotation)
    box = bounding_box(reached, home.position, machine.kinematics.characteristic_length)
    return volume(reached, box, points, np.random.default_rng(1))


def turned_volume(machine: Machine, largest: tuple[float, float, float], points: int) -> Volume:
    """Of the positions with some orientation whose roll, pitch, yaw are within ±largest, rad."""
    home, size = machine.kinematics.home, machine.kinematics.characteristic_length
    pilot = AnyOrientation(machine, np.array(largest), PILOT_STARTS, PILOT_ITERATIONS)
    box = bounding_box(pilot, home.position, size, min(PILOT, points))
    reached = AnyOrientation(machine, np.array(largest))
    return volume(reached, box, points, np.random.default_rng(1))


def findings(points: int, turned_points: int) -> Iterator[Finding]:
    """Level and turned, by geometry above the base's plane; level within the machine's limits."""
    machine = machines.load(MACHINE)
    above = free(machine, 0.0)
    yield _compared(
        'volume_level', 'workspace, level, by geometry alone', level_volume(above, points), 3e-4,
        'closed legs and z ≥ 0, as the paper’s model has no other limits; the paper does not say '
        'which rotations it allows',
    )  # fmt: skip
    turned = {}
    for key, (words, largest) in RANGES.items():
        turned[key] = turned_volume(above, largest, turned_points)
        yield _compared(
            f'volume_{key}', f'workspace, {words}', turned[key], 4e-3,
            'the same, with any rotation of these; a lower bound',
        )  # fmt: skip
    middle = 1e3 * turned['0.3'].value
    yield Finding(
        'volume_decimal', ROTARY, 'workspace, if 0.64 is a slipped decimal point',
        Claim('0.064 dm³ (our reading)', (0.064,), 0.015), f'{middle:.3f} dm³', (middle,), 'dm³',
        4e-3, 'the volumes with rotations lie on both sides of a tenth of the paper’s',
    )  # fmt: skip
    limited = level_volume(machine, points)
    yield Finding(
        'volume_limited', ROTARY, 'workspace, level, all limits of the machine file',
        unstated('not comparable: its model has no such limits'), _shown(limited),
        (1e3 * limited.value,), 'dm³', 3e-4,
        'crank travel, the lid, rod cones, distance from singularities',
    )  # fmt: skip


def _compared(key: str, topic: str, found: Volume, tolerance: float, reason: str) -> Finding:
    claim = Claim(TEXT, (PAPER,), 0.005, 0.32)
    return Finding(
        key, ROTARY, topic, claim, _shown(found), (1e3 * found.value,), 'dm³', tolerance, reason
    )


def _shown(found: Volume) -> str:
    digits = 5 if found.error < 1e-7 else 4
    return f'{1e3 * found.value:.{digits}f} ± {1e3 * found.error:.1g} dm³'
