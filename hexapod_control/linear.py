"""The linear Gough–Stewart platform as a `Kinematics`: six leg lengths, one pose."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.linear_geometry import LinearGeometry
from hexapod_control.parallel_platform import ParallelPlatform
from manipulator import _kernel
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class LinearPlatform(ParallelPlatform):
    """Kinematics of a platform on six legs that change their length.

    A joint's position is the leg's length between its joint centres, in metres: L of Lapikov et
    al. 2014, and no machine's zero. Every pose has one inverse; whether a leg can be as long as
    that is the business of `Constraints`. Construction as of `ParallelPlatform`.
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
        """Leg lengths (..., 6), Lapikov et al. 2014, section 2.1; `near` changes nothing."""
        return self.inverse_or_nan(pose, near)

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`: no leg fails to close."""
        lengths = np.empty((*pose.position.shape[:-1], LEGS))
        _kernel.linear_inverse(self.legs, pose.position, pose.rotation, lengths)
        return lengths

    def rod_lengths(self, joints: Array) -> Array:
        """The joints themselves; NoSolution where one is not above 0."""
        if not (joints > 0.0).all():
            leg = int(np.argmin(joints))
            raise NoSolution(f'leg {leg + 1}: length {joints[leg]:.4g} m is not above 0')
        return joints

    def joint_gains(self, pose: Pose, joints: Array) -> Array:
        """1 for every leg."""
        return np.ones(np.shape(joints))

    def leverage(self, pose: Pose, joints: Array) -> Array:
        """1 for every leg: linear legs have no inverse singularity."""
        return np.ones(np.shape(joints))

    def _legs(self) -> Array:
        """Cranks of length 0: the base points stand still, whatever the joints."""
        g, nothing = self.geometry, np.zeros(3 * LEGS)
        ends = (nothing, nothing, nothing, g.platform_points.T.ravel())
        return np.concatenate([g.base_points.T.ravel(), *ends, np.zeros(3 * LEGS)])
