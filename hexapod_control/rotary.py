"""The crank hexapod as a `Kinematics`: six crank angles, one pose."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from hexapod_control.geometry import LEGS, RotaryGeometry
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.platform_limits import SHORTFALL, SURPLUS, VALUES
from manipulator._kernel import crank_elbows, crank_gains, crank_inverse
from manipulator.arrays import Array, frozen, stretched
from manipulator.errors import InvalidInput, Unreachable
from manipulator.formatting import length
from manipulator.links import Stroke, outline
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class RotaryHexapod(ParallelPlatform):
    """Kinematics of a crank platform; angles in radians from each leg's tangent towards up.

    Crank angles are given within half a turn of crank_middles: (6,), or one for all legs.
    Construction as of `ParallelPlatform`.
    """

    geometry: RotaryGeometry
    crank_middles: Array

    def __post_init__(self) -> None:
        """One middle for each leg; then as `ParallelPlatform`."""
        self._put('crank_middles', frozen(np.broadcast_to(self.crank_middles, (LEGS,))))
        super().__post_init__()

    @property
    def joint_names(self) -> tuple[str, ...]:
        """crank_1 to crank_6."""
        return tuple(f'crank_{leg}' for leg in range(1, LEGS + 1))

    @property
    def joint_unit(self) -> str:
        """Radians."""
        return 'rad'

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Crank angles (..., 6); see `Kinematics`. Elbow out unless `near` is nearer elbow in."""
        position = pose.position
        joints = np.empty(LEGS if position.ndim == 1 else (*position.shape[:-1], LEGS))
        if near is not None:
            near = stretched(near, joints.shape)
        if crank_inverse(self.legs, position, pose.rotation, near, joints):
            self._explain(pose, joints, near)
        return joints

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`, with NaN for each crank whose leg does not close."""
        position = pose.position
        joints = np.empty((*position.shape[:-1], LEGS))
        if near is not None:
            near = stretched(near, joints.shape)
        crank_inverse(self.legs, position, pose.rotation, near, joints)
        return joints

    def inverse_all(self, pose: Pose) -> Array:
        """Every way to bend the legs (64, 6) for one pose, each elbow out or in; elbows out first.

        Within half a turn of crank_middles. Raises Unreachable where a leg does not close.
        """
        out, inside = self.inverse(pose), np.empty(LEGS)
        crank_elbows(self.legs, pose.position, pose.rotation, out, inside)
        is_out = np.array(list(product((True, False), repeat=LEGS)))
        return np.where(is_out, out, inside)

    def crank_tips(self, joints: Array) -> Array:
        """Where crank meets rod, (..., 6, 3), base frame, metres."""
        return self.base_points(joints)

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """The crank axes' outline, six cranks, six rods, the platform's outline."""
        centres, tips = self.geometry.crank_centres, self.crank_tips(joints)
        cranks = (Stroke('crank', ends) for ends in np.stack([centres, tips], axis=1))
        _, *others = super().skeleton(pose, joints)
        return outline('body', centres), *cranks, *others

    def rod_lengths(self, joints: Array) -> Array:
        """The rods' own, whatever the angles: (6,)."""
        return self.geometry.rod_lengths

    def joint_gains(self, pose: Pose, joints: Array) -> Array:
        """uᵢ·∂bᵢ/∂qᵢ (..., 6) in m/rad: how fast each crank's tip moves along its rod.

        0 where crank and rod are in line: an inverse singularity, where the crank is powerless.
        """
        units = self.unit_rods(pose, joints)
        gains = np.empty(units.shape[:-1])
        crank_gains(self.legs, stretched(joints, gains.shape), units, gains)
        return gains

    def leverage(self, pose: Pose, joints: Array) -> Array:
        """|gain| by crank length (..., 6): the part of the tip's way that goes along the rod."""
        leverage: Array = np.abs(self.joint_gains(pose, joints)) / self.geometry.crank_lengths
        return leverage

    def _legs(self) -> Array:
        g = self.geometry
        points = (g.crank_centres, g.normals, g.tangents, g.ups, g.platform_points)
        lengths = (g.crank_lengths, g.rod_lengths, self.crank_middles)
        return np.concatenate([*(p.T.ravel() for p in points), *lengths])

    def _explain(self, pose: Pose, joints: Array, near: Array | None) -> None:
        """Raises what made an angle NaN: an unusable `near`, or the leg that misses the most."""
        if near is not None and not np.isfinite(near).all():
            raise InvalidInput('the joints to stay near are not finite')
        is_open = np.isnan(joints).any(axis=-1)
        values = self.limits.limited_values(pose[is_open], joints[is_open]).reshape(-1, VALUES)
        lack, surplus = values[:, SHORTFALL], values[:, SURPLUS]
        row, leg = np.unravel_index(np.argmax(np.maximum(lack, surplus)), lack.shape)
        rod, is_short = self.geometry.rod_lengths[leg], lack[row, leg] > surplus[row, leg]
        miss = max(lack[row, leg], surplus[row, leg])
        raise Unreachable(
            f'leg {leg + 1}: rod too {"short" if is_short else "long"} by {length(miss, 3)} '
            f'({length(rod, 5)}, needs {length(rod + lack[row, leg], 5)} to '
            f'{length(rod - surplus[row, leg], 5)})',
            int(leg) + 1,
        )
