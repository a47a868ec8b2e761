"""Platforms whose parameters can be identified, and their values as lines of a machine file.

A crank platform has 12 joint centres, 6 cranks, 6 rods and 18 angles; one on linear legs 12 joint
centres and 6 lengths at zero (one on rails: rail_model.py). Files hold millimetres and degrees.
"""

import dataclasses
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import RotaryGeometry
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
from hexapod_control.identification.rail_model import RailModel
from hexapod_control.linear import LinearPlatform, linear_legs
from hexapod_control.linear_geometry import LinearGeometry
from hexapod_control.rails import RailGeometry, RailPlatform
from hexapod_control.rotary import RotaryHexapod
from manipulator import rotation as so3
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose
from manipulator.yaml_edit import flow_list


def geometry_lines(geometry: RotaryGeometry | LinearGeometry | RailGeometry) -> list[str]:
    """The `geometry` section by coordinates, to 0.1 µm."""
    home = [f'  home_height_mm: {1e3 * geometry.home_height:g}']
    for key, values in (
        ('home_xy_mm', 1e3 * geometry.home_xy),
        ('home_rpy_deg', np.degrees(geometry.home_rpy)),
    ):
        home += [f'  {key}: {flow_list(values)}'] if values.any() else []
    joints = _points('platform_joints_mm', 1e3 * geometry.platform_points)
    if isinstance(geometry, LinearGeometry):
        plain = [*_points('base_joints_mm', 1e3 * geometry.base_points), *joints, *home]
        return plain if geometry.screw_lead == 0.0 else [*plain, *_screw_lines(geometry)]
    if isinstance(geometry, RailGeometry):
        sides = ', '.join('behind' if side > 0 else 'ahead' for side in geometry.sides)
        return [
            *_points('rail_points_mm', 1e3 * geometry.rail_points),
            *_points('rail_directions', geometry.directions, DIGITS),
            *joints,
            f'  rod_length_mm: {flow_list(1e3 * geometry.rod_lengths)}',
            f'  carriages: [{sides}]',
            *home,
        ]
    level = np.cross(geometry.tangents, [0.0, 0.0, 1.0])
    off = level - np.linalg.norm(level, axis=1, keepdims=True) * geometry.normals
    are_as_assumed = np.abs(off).max() < 10.0**-DIGITS
    axes = [] if are_as_assumed else _points('crank_axes', geometry.normals, DIGITS)
    return [
        *_points('crank_centres_mm', 1e3 * geometry.crank_centres),
        *_points('crank_tangents', geometry.tangents, DIGITS),
        *axes,
        *joints,
        f'  crank_length_mm: {flow_list(1e3 * geometry.crank_lengths)}',
        f'  rod_length_mm: {flow_list(1e3 * geometry.rod_lengths)}',
        *home,
    ]


def _screw_lines(geometry: LinearGeometry) -> list[str]:
    return [
        f'  screw_lead_mm: {1e3 * geometry.screw_lead:g}',
        *_points('base_joint_axes', geometry.base_axes, DIGITS),
        *_points('platform_joint_axes', geometry.platform_axes, DIGITS),
    ]


def _points(key: str, points: Array, digits: int = 4) -> list[str]:
    return [f'  {key}:', *(f'    - {flow_list(point, digits)}' for point in points)]


DIGITS = 6
"""Of directions."""

CRANKS, RODS = slice(36, 42), slice(42, 48)
ZEROS, HEADINGS, TILTS = slice(48, 54), slice(54, 60), slice(60, 66)


@dataclass(frozen=True, eq=False)
class RotaryModel(LegModel):
    """See `Model`. A crank stands at its commanded angle and its zero angle; its plane is turned
    about the file's tangent by its tilt, then about the file's ups by its heading.
    """

    geometry: RotaryGeometry
    tolerances: Tolerances

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Anchors, platform joints, cranks, rods, zero angles, headings, tilts: 66."""
        length, angle = self.tolerances.length, self.tolerances.angle
        return (
            *points_parameters('anchor', 'anchors', length),
            *points_parameters('platform joint', 'joints', length),
            *leg_parameters('crank {} length', 'cranks', 'm', length),
            *leg_parameters('rod {} length', 'rods', 'm', length),
            *leg_parameters('crank {} zero angle', 'zeros', 'rad', angle),
            *leg_parameters('crank {} heading', 'headings', 'rad', angle),
            *leg_parameters('crank {} tilt', 'tilts', 'rad', angle),
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
        r = found.crank_lengths[:, None]
        sideways = (r * np.cross(axis, along) for axis in self._turning_axes(values))
        cranks, zeros, headings, tilts = (
            -(units * part).sum(axis=-1, keepdims=True) for part in (along, r * across, *sideways)
        )
        rods = -np.ones_like(cranks)
        own = (-units, arms, cranks, rods, zeros, headings, tilts)
        return np.concatenate([own_leg(part) for part in own], axis=2)

    def identified(self, values: Array) -> RotaryGeometry:
        """The geometry with these values; the zero angles are not in it."""
        g = self.geometry
        heading = so3.exp(values[HEADINGS, None] * g.ups)
        turns = heading @ so3.exp(values[TILTS, None] * g.tangents)
        return dataclasses.replace(
            g,
            crank_centres=g.crank_centres + values[ANCHORS].reshape(6, 3),
            platform_points=g.platform_points + values[JOINTS].reshape(6, 3),
            tangents=np.einsum('lij,lj->li', turns, g.tangents),
            normals=np.einsum('lij,lj->li', turns, g.normals),
            crank_lengths=g.crank_lengths + values[CRANKS],
            rod_lengths=g.rod_lengths + values[RODS],
        )

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true crank angle less the commanded one, rad."""
        return values[ZEROS]

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`."""
        g = self.identified(values)
        found = rigid_motions_of(g.crank_centres, g.platform_points, len(self.parameters))
        frames = np.stack([*self._turning_axes(values), g.normals], axis=-1)
        for motion, turns in turned_with_the_anchors(frames).items():
            found[motion][HEADINGS], found[motion][TILTS], found[motion][ZEROS] = turns
        return found

    def _turning_axes(self, values: Array) -> tuple[Array, Array]:
        """Unit vectors (6, 3), base axes, about which headings and tilts turn the cranks."""
        g = self.geometry
        heading = so3.exp(values[HEADINGS, None] * g.ups)
        return g.ups, np.einsum('lij,lj->li', heading, g.tangents)

    def _directions(
        self, found: RotaryGeometry, values: Array, joints: Array
    ) -> tuple[Array, Array]:
        """Unit vectors (n, 6, 3) from crank axis to tip, and in which the tip moves."""
        angles = (joints + self.joint_offsets(values))[..., None]
        cosine, sine = np.cos(angles), np.sin(angles)
        along = cosine * found.tangents + sine * found.ups
        return along, cosine * found.ups - sine * found.tangents


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
            base_points=g.base_points + values[ANCHORS].reshape(6, 3),
            platform_points=g.platform_points + values[JOINTS].reshape(6, 3),
        )

    def screw_turns(self, values: Array, poses: Pose) -> tuple[Array | float, Array | float]:
        """See `LegModel`; the axes of the joints are as in the file."""
        found = self.identified(values)
        if found.screw_lead == 0.0:
            return 0.0, 0.0
        return linear_legs(found).screw_turns(poses)

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true length less the commanded one, m."""
        return values[JOINTS.stop :]

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """See `Model`."""
        g = self.identified(values)
        return rigid_motions_of(g.base_points, g.platform_points, len(self.parameters))


def model_of(
    kinematics: Kinematics, tolerances: Tolerances
) -> RotaryModel | LinearModel | RailModel:
    """InvalidInput for a machine that is no platform."""
    if isinstance(kinematics, RotaryHexapod):
        return RotaryModel(kinematics.geometry, tolerances)
    if isinstance(kinematics, LinearPlatform):
        return LinearModel(kinematics.geometry, tolerances)
    if isinstance(kinematics, RailPlatform):
        return RailModel(kinematics.geometry, tolerances)
    raise InvalidInput(f'no model to identify for a {type(kinematics).__name__}')
