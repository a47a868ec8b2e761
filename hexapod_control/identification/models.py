"""Platforms whose parameters can be identified, and their values as lines of a machine file.

A crank platform has 12 joint centres, 6 cranks, 6 rods and 12 angles; one on linear legs 12 joint
centres and 6 lengths at zero. Files hold millimetres and degrees.
"""

import dataclasses
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import RotaryGeometry
from hexapod_control.identification.leg_model import (
    LegModel,
    Legs,
    Tolerances,
    leg_parameters,
    own_leg,
    points_parameters,
    rigid_point_motions,
)
from hexapod_control.linear import LinearPlatform
from hexapod_control.linear_geometry import LinearGeometry
from hexapod_control.rotary import RotaryHexapod
from manipulator import rotation as so3
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.kinematics import Kinematics
from manipulator.yaml_edit import flow_list


def geometry_lines(geometry: RotaryGeometry | LinearGeometry) -> list[str]:
    """The `geometry` section by coordinates, to 0.1 µm."""
    home = [f'  home_height_mm: {1e3 * geometry.home_height:g}']
    for key, values in (
        ('home_xy_mm', 1e3 * geometry.home_xy),
        ('home_rpy_deg', np.degrees(geometry.home_rpy)),
    ):
        home += [f'  {key}: {flow_list(values)}'] if values.any() else []
    joints = _points('platform_joints_mm', 1e3 * geometry.platform_points)
    if isinstance(geometry, LinearGeometry):
        return [*_points('base_joints_mm', 1e3 * geometry.base_points), *joints, *home]
    return [
        *_points('crank_centres_mm', 1e3 * geometry.crank_centres),
        *_points('crank_tangents', geometry.tangents, 6),
        *joints,
        f'  crank_length_mm: {flow_list(1e3 * geometry.crank_lengths)}',
        f'  rod_length_mm: {flow_list(1e3 * geometry.rod_lengths)}',
        *home,
    ]


def _points(key: str, points: Array, digits: int = 4) -> list[str]:
    return [f'  {key}:', *(f'    - {flow_list(point, digits)}' for point in points)]


UP = np.array([0.0, 0.0, 1.0])
ANCHORS, JOINTS = slice(0, 18), slice(18, 36)
CRANKS, RODS = slice(36, 42), slice(42, 48)
ZEROS, HEADINGS = slice(48, 54), slice(54, 60)


@dataclass(frozen=True, eq=False)
class RotaryModel(LegModel):
    """See `Model`. A crank stands at its commanded angle and its zero angle; its plane is
    vertical and turned about z by its heading.
    """

    geometry: RotaryGeometry
    tolerances: Tolerances

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Anchors, platform joints, cranks, rods, zero angles, headings: 60."""
        length, angle = self.tolerances.length, self.tolerances.angle
        return (
            *points_parameters('anchor', 'anchors', length),
            *points_parameters('platform joint', 'joints', length),
            *leg_parameters('crank {} length', 'cranks', 'm', length),
            *leg_parameters('rod {} length', 'rods', 'm', length),
            *leg_parameters('crank {} zero angle', 'zeros', 'rad', angle),
            *leg_parameters('crank {} heading', 'headings', 'rad', angle),
        )

    def legs(self, values: Array, joints: Array) -> Legs:
        """See `LegModel`."""
        found = self.identified(values)
        arms = self._directions(found, values, joints)[0] * found.crank_lengths[:, None]
        lengths = np.broadcast_to(found.rod_lengths, joints.shape)
        return Legs(found.crank_centres + arms, found.platform_points, lengths)

    def gap_slopes(self, values: Array, joints: Array, units: Array, arms: Array) -> Array:
        """See `LegModel`."""
        found = self.identified(values)
        along, across = self._directions(found, values, joints)
        sideways = np.cross(UP, along)
        r = found.crank_lengths[:, None]
        cranks, zeros, headings = (
            -(units * part).sum(axis=-1, keepdims=True)
            for part in (along, r * across, r * sideways)
        )
        rods = -np.ones_like(cranks)
        own = (-units, arms, cranks, rods, zeros, headings)
        return np.concatenate([own_leg(part) for part in own], axis=2)

    def identified(self, values: Array) -> RotaryGeometry:
        """The geometry with these values; the zero angles are not in it."""
        g = self.geometry
        turns = so3.exp(values[HEADINGS, None] * UP)
        return dataclasses.replace(
            g,
            crank_centres=g.crank_centres + values[ANCHORS].reshape(6, 3),
            platform_points=g.platform_points + values[JOINTS].reshape(6, 3),
            tangents=np.einsum('lij,lj->li', turns, g.tangents),
            crank_lengths=g.crank_lengths + values[CRANKS],
            rod_lengths=g.rod_lengths + values[RODS],
        )

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true crank angle less the commanded one, rad."""
        return values[ZEROS]

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`. The planes stay vertical: turned about x or y, the base is another."""
        g = self.identified(values)
        found: dict[str, Array] = {}
        sides = ((ANCHORS, g.crank_centres, 'anchors'), (JOINTS, g.platform_points, 'joints'))
        for part, points, side in sides:
            name = 'the anchors' if side == 'anchors' else 'the platform joints'
            for motion, direction in rigid_point_motions(points, name).items():
                found[motion] = np.zeros(60)
                found[motion][part] = direction
                if part is ANCHORS and motion.endswith('about z'):
                    found[motion][HEADINGS] = 1.0
        return found

    def _directions(
        self, found: RotaryGeometry, values: Array, joints: Array
    ) -> tuple[Array, Array]:
        """Unit vectors (n, 6, 3) from crank axis to tip, and in which the tip moves."""
        angles = (joints + self.joint_offsets(values))[..., None]
        cosine, sine = np.cos(angles), np.sin(angles)
        along = cosine * found.tangents + sine * found.ups
        return along, cosine * found.ups - sine * found.tangents


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
        return dataclasses.replace(
            g,
            base_points=g.base_points + values[:POINTS].reshape(6, 3),
            platform_points=g.platform_points + values[POINTS : 2 * POINTS].reshape(6, 3),
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


def model_of(kinematics: Kinematics, tolerances: Tolerances) -> RotaryModel | LinearModel:
    """InvalidInput for a machine that is no platform."""
    if isinstance(kinematics, RotaryHexapod):
        return RotaryModel(kinematics.geometry, tolerances)
    if isinstance(kinematics, LinearPlatform):
        return LinearModel(kinematics.geometry, tolerances)
    raise InvalidInput(f'no model to identify for a {type(kinematics).__name__}')
