"""The crank hexapod as a `Kinematics`: six crank angles, one pose."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hexapod_control.geometry import LEGS, RotaryGeometry
from hexapod_control.legs import LegKind, Legs
from hexapod_control.parallel_platform import ParallelPlatform
from manipulator.arrays import Array, frozen
from manipulator.links import Stroke, outline
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class RotaryHexapod(ParallelPlatform):
    """Kinematics of a crank platform; angles in radians from each leg's tangent towards up.

    Crank angles are given within half a turn of crank_middles, (6,) or one for all legs, with the
    elbow out unless joints to stay near are nearer elbow in. Construction as of
    `ParallelPlatform`.
    """

    geometry: RotaryGeometry
    crank_middles: Array
    powerless: ClassVar[str] = 'a crank and its rod are in line'

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

    def crank_tips(self, joints: Array) -> Array:
        """Where crank meets rod, (..., 6, 3), base frame, metres."""
        return self.base_points(joints)

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """The crank axes' outline, six cranks, six rods, the platform's outline."""
        centres, tips = self.geometry.crank_centres, self.crank_tips(joints)
        cranks = (Stroke('crank', ends) for ends in np.stack([centres, tips], axis=1))
        _, *others = super().skeleton(pose, joints)
        return outline('body', centres), *cranks, *others

    def _legs(self) -> Legs:
        g = self.geometry
        return Legs.of(
            LegKind.CRANK,
            g.crank_centres,
            g.platform_points,
            axes=(g.normals, g.tangents, g.ups),
            cranks=g.crank_lengths,
            rods=g.rod_lengths,
            middles=self.crank_middles,
        )
