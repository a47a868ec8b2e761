"""How far the ball joints at both ends of a rod may swing: docs/kinematics.md, section 6.

A rod end turns freely about its bolt, and tilts only as far as its housing lets it.
"""

from dataclasses import dataclass, field

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.leg_jacobian import MANY, chunks, turned_columns, unit_rods_and_arms
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.rotary import RotaryHexapod
from manipulator.arrays import Array, Mask, frozen
from manipulator.pose import Pose

LEG_NAMES = tuple(f'leg {leg}' for leg in range(1, LEGS + 1))


@dataclass(frozen=True, eq=False)
class PlatformJointSwing:
    """The rod's angle (rad) to its direction at home, as the platform sees it: a cone."""

    kinematics: ParallelPlatform
    largest: float
    quantity: str = 'platform joint swing'
    unit: str = 'rad'
    owners: tuple[str, ...] = LEG_NAMES
    low: Array = field(init=False)
    high: Array = field(init=False)
    at_home: Array = field(init=False)

    def __post_init__(self) -> None:
        """Remembers the six directions at home."""
        home = self.kinematics.home
        at_home = self._directions(home, self.kinematics.inverse(home))
        object.__setattr__(self, 'at_home', frozen(at_home))
        object.__setattr__(self, 'low', frozen(np.full(LEGS, -np.inf)))
        object.__setattr__(self, 'high', frozen(np.full(LEGS, self.largest)))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The angles (..., 6)."""
        cosine = (self._directions(pose, joints) * self.at_home).sum(axis=-1)
        angle: Array = np.arccos(np.clip(cosine, -1.0, 1.0))
        return angle

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Which configurations (...) keep the cone; many at once by their cosines."""
        if joints.ndim != 2 or len(joints) < MANY:
            return np.asarray((self.values(pose, joints) <= self.largest).all(axis=-1))
        inside = np.empty(len(joints), dtype=np.bool_)
        points, least = self.kinematics.geometry.platform_points, np.cos(self.largest)
        for part, poses, some in chunks(pose, joints):
            base = self.kinematics.base_points(some)
            units, _ = unit_rods_and_arms(base, points, poses)
            cosine = (units * self._axes(poses)).sum(axis=0)
            inside[part] = (cosine >= least).all(axis=0)
        return inside

    def _axes(self, pose: Pose) -> Array:
        """The cones' axes in base axes, (3, 6, N)."""
        return turned_columns(self.at_home, pose)

    def _directions(self, pose: Pose, joints: Array) -> Array:
        """The rods' unit vectors as the platform sees them."""
        directions: Array = self.kinematics.unit_rods(pose, joints) @ pose.rotation
        return directions


@dataclass(frozen=True, eq=False)
class BaseJointSwing(PlatformJointSwing):
    """A linear leg's angle (rad) to its direction at home, as the base sees it: a cone."""

    quantity: str = 'base joint swing'

    def _axes(self, pose: Pose) -> Array:
        axes: Array = self.at_home.T[:, :, None]
        return axes

    def _directions(self, pose: Pose, joints: Array) -> Array:
        return self.kinematics.unit_rods(pose, joints)


@dataclass(frozen=True, eq=False)
class CrankJointTilt:
    """The change (rad) since home of the rod's angle to the plane in which its crank turns.

    The bolt of this joint is parallel to the servo's axis, about which the rod turns freely.
    """

    kinematics: RotaryHexapod
    largest: float
    quantity: str = 'crank joint tilt'
    unit: str = 'rad'
    owners: tuple[str, ...] = LEG_NAMES
    low: Array = field(init=False)
    high: Array = field(init=False)
    at_home: Array = field(init=False)

    def __post_init__(self) -> None:
        """Remembers the six tilts at home."""
        home = self.kinematics.home
        tilt = self._tilt(home, self.kinematics.inverse(home))
        object.__setattr__(self, 'at_home', frozen(tilt))
        object.__setattr__(self, 'low', frozen(np.full(LEGS, -self.largest)))
        object.__setattr__(self, 'high', frozen(np.full(LEGS, self.largest)))

    def values(self, pose: Pose, joints: Array) -> Array:
        """The tilts (..., 6), signed."""
        change: Array = self._tilt(pose, joints) - self.at_home
        return change

    def admits(self, pose: Pose, joints: Array) -> Mask:
        """Which configurations (...) keep the tilt; many at once by the sine, AE of (2.1) by d."""
        if joints.ndim != 2 or len(joints) < MANY:
            return np.asarray((np.abs(self.values(pose, joints)) <= self.largest).all(axis=-1))
        ends = self.at_home + np.array([[-self.largest], [self.largest]])
        lengths = self.kinematics.geometry.rod_lengths
        low, high = (np.sin(np.clip(ends, -np.pi / 2, np.pi / 2)) * lengths)[:, :, None]
        inside = np.empty(len(joints), dtype=np.bool_)
        for part, poses, some in chunks(pose, joints):
            across = self.kinematics.closure.gaps(poses)[:LEGS]
            kept = ((across >= low) & (across <= high)).all(axis=0)
            inside[part] = kept & np.isfinite(some).all(axis=-1)
        return inside

    def _tilt(self, pose: Pose, joints: Array) -> Array:
        sine = (self.kinematics.unit_rods(pose, joints) * self.kinematics.geometry.normals).sum(-1)
        tilt: Array = np.arcsin(np.clip(sine, -1.0, 1.0))
        return tilt
