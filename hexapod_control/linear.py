"""The linear Gough–Stewart platform as a `Kinematics`: six leg lengths, one pose."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS, unit_vectors
from hexapod_control.legs import LegKind, Legs
from hexapod_control.linear_geometry import LinearGeometry
from hexapod_control.parallel_platform import ParallelPlatform
from manipulator.arrays import Array
from manipulator.errors import ConfigError, NoSolution
from manipulator.pose import Pose

LEAST_ANGLE_DEG = 10.0
"""Between the fixed axis of a cardan joint and its leg: along the leg it could not bend."""


@dataclass(frozen=True, eq=False)
class LinearPlatform(ParallelPlatform):
    """Kinematics of a platform on six legs that change their length.

    A joint's position is the leg's length between its joint centres, in metres: L of Lapikov et
    al. 2014, and no machine's zero. Of screws between cardan joints it is the length to which the
    motor turned them: docs/kinematics.md, section 8.4. Every pose has one inverse; whether a leg
    can be as long as that is the business of `Constraints`. Construction as of
    `ParallelPlatform`.
    """

    geometry: LinearGeometry

    @property
    def joint_names(self) -> tuple[str, ...]:
        """leg_1 to leg_6."""
        return tuple(f'leg_{leg}' for leg in range(1, LEGS + 1))

    @property
    def joint_unit(self) -> str:
        """Metres."""
        return 'm'

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Leg lengths (..., 6), Lapikov et al. 2014, section 2.1; no leg fails to close."""
        return self.inverse_or_nan(pose, near)

    def inverse_all(self, pose: Pose) -> Array:
        """The one set of lengths, (1, 6): a leg that changes its length does not bend."""
        return self.inverse(pose)[None]

    def rod_lengths(self, joints: Array) -> Array:
        """The joints themselves; NoSolution where one is not above 0."""
        if not (joints > 0.0).all():
            leg = int(np.argmin(joints))
            raise NoSolution(f'leg {leg + 1}: length {joints[leg]:.4g} m is not above 0')
        return joints

    def leg_jacobian(self, pose: Pose, joints: Array) -> Array:
        """J (..., 6, 6): J·twist is how fast each joint grows, m/s; screws turn with the twist."""
        rows = super().leg_jacobian(pose, joints)
        if self.geometry.screw_lead != 0.0:
            rows += self.legs.screw_turns(pose)[1]
        return rows

    def _legs(self) -> Legs:
        return linear_legs(self.geometry)


def linear_legs(geometry: LinearGeometry) -> Legs:
    """The legs as the kernel takes them; ConfigError for cardan axes that cannot be, at home.

    An axis has two directions: the platform's are taken in that which turns the screw less.
    """
    g, home = geometry, geometry.home
    if g.screw_lead == 0.0:
        return Legs.of(LegKind.LINEAR, g.base_points, g.platform_points)
    rods = home.transform(g.platform_points) - g.base_points
    units = rods / np.linalg.norm(rods, axis=1, keepdims=True)
    axes = (
        unit_vectors(g.base_axes, 'base_joint_axes'),
        unit_vectors(g.platform_axes, 'platform_joint_axes'),
    )
    below, above = axes[0], axes[1] @ home.rotation.T
    _check_across(below, units, 'base_joint_axes')
    _check_across(above, units, 'platform_joint_axes')
    across = [axis - (axis * units).sum(axis=1, keepdims=True) * units for axis in (below, above)]
    sense = np.where((across[0] * across[1]).sum(axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    screws = (g.screw_lead, axes[0], sense * axes[1])
    return Legs.of(LegKind.LINEAR, g.base_points, g.platform_points, screws=screws)


def _check_across(axes: Array, units: Array, key: str) -> None:
    angles = np.degrees(np.arccos(np.clip(np.abs((axes * units).sum(axis=1)), 0.0, 1.0)))
    problems = [
        f'leg {leg}: {key}[{leg - 1}] is at {angle:.1f}° to its leg at home, a cardan joint needs '
        f'{LEAST_ANGLE_DEG:g}° or more'
        for leg, angle in enumerate(angles.tolist(), start=1)
        if angle < LEAST_ANGLE_DEG
    ]
    if problems:
        raise ConfigError(problems)
