"""A platform on rails whose parameters can be identified."""

import dataclasses
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.identification.leg_model import (
    ANCHORS,
    JOINTS,
    LegModel,
    Legs,
    Tolerances,
    leg_parameters,
    own_leg,
    points_parameters,
    rigid_motions_of,
    turned_with_the_anchors,
)
from hexapod_control.rails import RailGeometry
from manipulator import rotation as so3
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array

RODS = slice(36, 42)
YAWS, PITCHES = slice(42, 48), slice(48, 54)


@dataclass(frozen=True, eq=False)
class RailModel(LegModel):
    """See `Model`. A rail is turned by its pitch, then by its yaw, about two axes square to it.

    A carriage's zero is no parameter: it would move the anchor along the rail.
    """

    geometry: RailGeometry
    tolerances: Tolerances

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Anchors, platform joints, rods, directions of the rails: 54."""
        length, angle = self.tolerances.length, self.tolerances.angle
        return (
            *points_parameters('anchor', 'anchors', length),
            *points_parameters('platform joint', 'joints', length),
            *leg_parameters('rod {} length', 'rods', 'm', length),
            *leg_parameters('rail {} yaw', 'rails', 'rad', angle),
            *leg_parameters('rail {} pitch', 'rails', 'rad', angle),
        )

    def legs(self, values: Array, joints: Array) -> Legs:
        """See `LegModel`."""
        found = self.identified(values)
        base = found.rail_points + joints[..., None] * found.directions
        return Legs(base, found.platform_points, np.broadcast_to(found.rod_lengths, joints.shape))

    def gap_slopes(self, values: Array, joints: Array, units: Array, arms: Array) -> Array:
        """See `LegModel`."""
        directions = self.identified(values).directions
        yaws, pitches = (
            -(units * joints[..., None] * np.cross(axis, directions)).sum(axis=-1, keepdims=True)
            for axis in self._turning_axes(values)
        )
        own = (-units, arms, -np.ones_like(yaws), yaws, pitches)
        return np.concatenate([own_leg(part) for part in own], axis=2)

    def identified(self, values: Array) -> RailGeometry:
        """The geometry with these values."""
        g = self.geometry
        first, second = self._turning_axes(values)
        turns = so3.exp(values[PITCHES, None] * second) @ so3.exp(values[YAWS, None] * first)
        return dataclasses.replace(
            g,
            rail_points=g.rail_points + values[ANCHORS].reshape(6, 3),
            platform_points=g.platform_points + values[JOINTS].reshape(6, 3),
            directions=np.einsum('lij,lj->li', turns, g.directions),
            rod_lengths=g.rod_lengths + values[RODS],
        )

    def joint_offsets(self, values: Array) -> Array:
        """(6,): 0, the anchors hold the zeros."""
        return np.zeros(LEGS)

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`."""
        g = self.identified(values)
        found = rigid_motions_of(g.rail_points, g.platform_points, len(self.parameters))
        frames = np.stack([*self._turning_axes(values), g.directions], axis=-1)
        for motion, turns in turned_with_the_anchors(frames).items():
            found[motion][YAWS], found[motion][PITCHES] = turns[:2]
        return found

    def _turning_axes(self, values: Array) -> tuple[Array, Array]:
        """Unit vectors (6, 3), base axes, about which yaws and pitches turn the rails."""
        along = self.geometry.directions
        least = np.eye(3)[np.abs(along).argmin(axis=1)]
        first = np.cross(along, least)
        first /= np.linalg.norm(first, axis=1, keepdims=True)
        second = np.cross(first, along)
        yaw = so3.exp(values[YAWS, None] * first)
        return first, np.einsum('lij,lj->li', yaw, second)
