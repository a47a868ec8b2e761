"""What tolerances of a platform's geometry do to its pose: docs/workspace.md, section 5."""

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from hexapod_control.parallel_platform import ParallelPlatform
from manipulator.analysis.accuracy import Spread, linear_law, spread_of
from manipulator.arrays import Array
from manipulator.pose import Pose

TOLERANT = (
    'crank_centres',
    'base_points',
    'rail_points',
    'platform_points',
    'crank_lengths',
    'rod_lengths',
)
STEP = 1e-6


@dataclass(frozen=True)
class GeometryErrors:
    """Every coordinate of a joint and every length off by a normal error, `deviation` (m) each.

    All are independent; the directions of cranks and rails are taken as exact.
    """

    deviation: float

    def linear_spread(self, kinematics: ParallelPlatform, pose: Pose) -> Spread:
        """To first order, at one pose."""
        slopes = geometry_slopes(kinematics, pose)
        return linear_law(slopes, np.full(slopes.shape[1], self.deviation**2))

    def drawn_spread(
        self, kinematics: ParallelPlatform, pose: Pose, count: int, generator: np.random.Generator
    ) -> Spread:
        """From `count` machines built with errors, all with the joints of the exact one."""
        joints, total = kinematics.inverse(pose), parameters(kinematics)
        errors = self.deviation * generator.standard_normal((count, total))
        built = (with_errors(kinematics, error) for error in errors)
        return spread_of(pose, [machine.forward(joints, pose).pose for machine in built])


def parameters(kinematics: ParallelPlatform) -> int:
    """How many coordinates and lengths the geometry has."""
    return sum(array.size for array in _tolerant(kinematics).values())


def geometry_slopes(kinematics: ParallelPlatform, pose: Pose) -> Array:
    """(6, p): the platform's twist from `pose` by each parameter, joints held; by differences."""
    joints, total = kinematics.inverse(pose), parameters(kinematics)
    columns = []
    for change in STEP * np.eye(total):
        ahead, behind = (
            with_errors(kinematics, sign * change).forward(joints, pose).pose for sign in (1, -1)
        )
        columns.append(behind.twist_to(ahead) / (2 * STEP))
    return np.stack(columns, axis=1)


def with_errors(kinematics: ParallelPlatform, errors: Array) -> ParallelPlatform:
    """The same kind of machine with `errors` (p,) in metres added to its geometry."""
    changed, start = {}, 0
    for name, array in _tolerant(kinematics).items():
        changed[name] = array + errors[start : start + array.size].reshape(array.shape)
        start += array.size
    geometry: Any = kinematics.geometry
    return dataclasses.replace(kinematics, geometry=dataclasses.replace(geometry, **changed))


def _tolerant(kinematics: ParallelPlatform) -> dict[str, Array]:
    geometry = kinematics.geometry
    return {name: getattr(geometry, name) for name in TOLERANT if hasattr(geometry, name)}
