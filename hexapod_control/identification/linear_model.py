"""The parameters of a platform on linear legs: 12 joint centres and 6 lengths at zero."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.identification.leg_model import (
    LegModel,
    Legs,
    Tolerances,
    leg_parameters,
    own_leg,
    points_parameters,
    rigid_point_motions,
)
from hexapod_control.linear_geometry import LinearGeometry
from manipulator.arrays import Array
from manipulator.identification.model import Parameter

POINTS = 18


@dataclass(frozen=True, eq=False)
class LinearModel(LegModel):
    """See `Model`. A leg is as long as it is commanded, and its length offset."""

    geometry: LinearGeometry
    tolerances: Tolerances

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Anchors, platform joints, length offsets: 42."""
        length = self.tolerances.length
        return (
            *points_parameters('anchor', 'anchors', length),
            *points_parameters('platform joint', 'joints', length),
            *leg_parameters('leg {} length offset', 'zeros', 'm', length),
        )

    def legs(self, values: Array, joints: Array) -> Legs:
        """See `LegModel`."""
        found = self.identified(values)
        base = np.broadcast_to(found.base_points, (len(joints), *found.base_points.shape))
        return Legs(base, found.platform_points, joints + self.joint_offsets(values))

    def gap_slopes(self, values: Array, joints: Array, units: Array, arms: Array) -> Array:
        """See `LegModel`."""
        ones = np.ones((*units.shape[:2], 1))
        return np.concatenate([own_leg(-units), own_leg(arms), own_leg(-ones)], axis=2)

    def identified(self, values: Array) -> LinearGeometry:
        """The geometry with these values."""
        g = self.geometry
        return LinearGeometry(
            g.base_points + values[:POINTS].reshape(6, 3),
            g.platform_points + values[POINTS : 2 * POINTS].reshape(6, 3),
            g.home_height,
        )

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true length less the commanded one, m."""
        return values[2 * POINTS :]

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`."""
        g = self.identified(values)
        base = rigid_point_motions(g.base_points, 'the anchors')
        platform = rigid_point_motions(g.platform_points, 'the platform joints')
        nothing, offsets = np.zeros(POINTS), np.zeros(6)
        return {name: np.concatenate([v, nothing, offsets]) for name, v in base.items()} | {
            name: np.concatenate([nothing, v, offsets]) for name, v in platform.items()
        }
