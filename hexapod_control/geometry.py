"""Where the joints of a crank hexapod are: the paper's parameters or explicit coordinates.

Machines whose joints alone show that leg lengths never fix the pose are rejected.
"""

from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from hexapod_control.leg_jacobian import leg_jacobian, smallest_singular_value
from manipulator import rotation as so3
from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, SIZE_MM, TURN_DEG, quantity
from manipulator.errors import ConfigError
from manipulator.motion_limits import SixNumbers
from manipulator.pose import Pose

LEGS = 6
Triple: TypeAlias = tuple[float, float, float]
SixPoints: TypeAlias = tuple[Triple, Triple, Triple, Triple, Triple, Triple]
Range: TypeAlias = tuple[float, float]
SixRanges: TypeAlias = tuple[Range, Range, Range, Range, Range, Range]
VERTICAL_TANGENT = 0.999
SQUARE = float(np.radians(1.0))
"""How far from a right angle a crank's axis and tangent may be: numbers in files are rounded."""

LEAST_DIRECTION = 1e-9
VERTICAL_PLANES = frozen(np.zeros((LEGS, 3)))

CRANK_LENGTH = "from a crank's axis to its rod end; one number for all, or six"
ROD_LENGTH = 'between the joints of a rod; one number for all, or six'
PLATFORM_JOINTS = "the legs' joints on the platform, platform frame"
HOME_HEIGHT = 'the platform frame above the base frame at home; below: negative'
HOME_XY, ORIGIN = "the platform's x and y at home", (0.0, 0.0)
HOME_RPY, LEVEL = "the platform's roll, pitch and yaw at home", (0.0, 0.0, 0.0)
"""Meanings of keys that several forms have."""


@dataclass(frozen=True, eq=False, kw_only=True)
class AtHome:
    """Where a platform is at home, beside its height: level above the origin, unless given.

    home_xy (2,) in metres, home_rpy (3,) in radians, base frame.
    """

    home_xy: Array = field(default_factory=lambda: frozen(np.zeros(2)))
    home_rpy: Array = field(default_factory=lambda: frozen(np.zeros(3)))

    def home_at(self, height: float) -> Pose:
        """Home, for the platform's height there."""
        return Pose.from_xyz_rpy([*self.home_xy, height], self.home_rpy)


def at_home(xy_mm: tuple[float, float], rpy_deg: Triple) -> dict[str, Any]:
    """The fields of `AtHome`, by the keys."""
    return {
        'home_xy': frozen(1e-3 * np.array(xy_mm)),
        'home_rpy': frozen(np.radians(rpy_deg)),
    }


@dataclass(frozen=True, eq=False)
class RotaryGeometry(AtHome):
    """Six cranks and rods in metres; see docs/kinematics.md, section 1.

    Crank i turns by the right hand about normals[i] through crank_centres[i] (base frame); its
    angle counts from tangents[i] towards ups[i] = normals[i] × tangents[i]. Its rod ends at
    platform_points[i] (platform frame). By default the plane of each crank is the vertical one
    through its tangent, with ups as far up as it allows. home_height is the platform's height at
    home, see `AtHome`. ConfigError names directions that are none, or not square.
    """

    crank_centres: Array
    tangents: Array
    platform_points: Array
    crank_lengths: Array
    rod_lengths: Array
    home_height: float
    normals: Array = field(default_factory=lambda: VERTICAL_PLANES)
    ups: Array = field(init=False)

    @property
    def home(self) -> Pose:
        """T_base_platform at home."""
        return self.home_at(self.home_height)

    def __post_init__(self) -> None:
        """Makes directions unit vectors, and tangents exactly square to the axes."""
        for name in ('crank_centres', 'platform_points'):
            object.__setattr__(self, name, frozen(getattr(self, name)))
        for name in ('crank_lengths', 'rod_lengths'):
            lengths = np.broadcast_to(getattr(self, name), (LEGS,))
            object.__setattr__(self, name, frozen(lengths))
        tangents = unit_vectors(self.tangents, 'crank_tangents')
        if np.any(self.normals):
            normals = unit_vectors(self.normals, 'crank_axes')
            _check_square(tangents, normals)
            along = (tangents * normals).sum(axis=1, keepdims=True)
            tangents = unit_vectors(tangents - along * normals, 'crank_tangents')
        else:
            _check_not_vertical(tangents)
            normals = unit_vectors(np.cross(tangents, [0.0, 0.0, 1.0]), 'crank_axes')
        object.__setattr__(self, 'tangents', frozen(tangents))
        object.__setattr__(self, 'ups', frozen(np.cross(normals, tangents)))
        object.__setattr__(self, 'normals', frozen(normals))


def unit_vectors(vectors: ArrayLike, key: str) -> Array:
    """Directions (6, 3) at length 1; ConfigError names, by `key`, those without a direction."""
    given = np.asarray(vectors, dtype=np.float64)
    lengths = np.sqrt((given * given).sum(axis=1, keepdims=True))
    problems = [
        f'leg {leg}: {key}[{leg - 1}] has no direction'
        for leg, length in enumerate(lengths.ravel().tolist(), start=1)
        if not length >= LEAST_DIRECTION
    ]
    if problems:
        raise ConfigError(problems)
    unit: Array = given / lengths
    return unit


def _check_square(tangents: Array, normals: Array) -> None:
    angles = np.arccos(np.clip((tangents * normals).sum(axis=1), -1.0, 1.0))
    problems = [
        f'leg {leg}: crank_axes[{leg - 1}] is at {np.degrees(angle):.1f}° to its '
        f'crank_tangents[{leg - 1}], needs 90° ± {np.degrees(SQUARE):g}°'
        for leg, angle in enumerate(angles.tolist(), start=1)
        if abs(angle - np.pi / 2) > SQUARE
    ]
    if problems:
        raise ConfigError(problems)


def _check_not_vertical(tangents: Array) -> None:
    problems = [
        f'leg {leg}: crank_tangents[{leg - 1}] is vertical, so the plane of the crank needs '
        'crank_axes'
        for leg, slope in enumerate(tangents[:, 2].tolist(), start=1)
        if abs(slope) > VERTICAL_TANGENT
    ]
    if problems:
        raise ConfigError(problems)


@dataclass(frozen=True)
class HexagonConfig:
    """The `geometry` section by the parameters of Prokopovich 2019, fig. 4, in millimetres."""

    body_radius_mm: float = quantity(*SIZE_MM, 'R: from the axis to each side of the body')
    crank_offset_mm: float = quantity(*PLACE_MM, 'p: how far the cranks are outside that')
    crank_shift_mm: float = quantity(
        *PLACE_MM, "q: the cranks' axes from the middle of a side, along it"
    )
    crank_length_mm: float | SixNumbers = quantity(*SIZE_MM, CRANK_LENGTH)
    rod_length_mm: float | SixNumbers = quantity(*SIZE_MM, ROD_LENGTH)
    joint_inset_mm: float = quantity(*PLACE_MM, "l: how far the platform's joints are inside R")
    joint_shift_mm: float = quantity(
        *PLACE_MM, "s: the platform's joints from the middle of a side, along it"
    )
    home_height_mm: float = quantity(*PLACE_MM, HOME_HEIGHT)
    home_xy_mm: Range = quantity(*PLACE_MM, HOME_XY, default=ORIGIN)
    home_rpy_deg: Triple = quantity(*TURN_DEG, HOME_RPY, default=LEVEL)

    def geometry(self) -> RotaryGeometry:
        """The joints by Prokopovich 2019, eqs (5) and (6), in closed form.

        Leg i stands at (i − 1)·60°; even legs mirror the odd ones (σ = −1, +1, −1 …). A platform
        that hangs is that machine upside down, with the same crank angles.
        """
        sigma = np.array([-1.0, 1.0] * 3)
        zero, one = np.zeros(LEGS), np.ones(LEGS)
        outer = (self.body_radius_mm + self.crank_offset_mm) * one
        inner = (self.body_radius_mm - self.joint_inset_mm) * one
        tangents = _around(zero, -sigma, zero)
        up = np.copysign([0.0, 0.0, 1.0], self.home_height_mm)
        return RotaryGeometry(
            crank_centres=_around(outer, sigma * self.crank_shift_mm, zero) * 1e-3,
            tangents=tangents,
            normals=np.cross(tangents, up),
            platform_points=_around(inner, -sigma * self.joint_shift_mm, zero) * 1e-3,
            crank_lengths=np.asarray(self.crank_length_mm) * 1e-3,
            rod_lengths=np.asarray(self.rod_length_mm) * 1e-3,
            home_height=self.home_height_mm * 1e-3,
            **at_home(self.home_xy_mm, self.home_rpy_deg),
        )


@dataclass(frozen=True)
class JointsConfig:
    """The `geometry` section by coordinates, in millimetres: a machine as it was measured.

    crank_tangents (no unit, any length) point to where the crank angle is 0. crank_axes (likewise)
    are what the cranks turn about, by the right hand; without them every crank turns in the
    vertical plane of its tangent, which is 0, from there upwards.
    """

    crank_centres_mm: SixPoints = quantity(
        *PLACE_MM, "where each crank's axis meets the plane of its rod end, base frame"
    )
    crank_tangents: SixPoints = quantity(
        -1000, 1000, 'where each crank points at angle 0, base frame; of any length'
    )
    platform_joints_mm: SixPoints = quantity(*PLACE_MM, PLATFORM_JOINTS)
    crank_length_mm: float | SixNumbers = quantity(*SIZE_MM, CRANK_LENGTH)
    rod_length_mm: float | SixNumbers = quantity(*SIZE_MM, ROD_LENGTH)
    home_height_mm: float = quantity(*PLACE_MM, HOME_HEIGHT)
    home_xy_mm: Range = quantity(*PLACE_MM, HOME_XY, default=ORIGIN)
    home_rpy_deg: Triple = quantity(*TURN_DEG, HOME_RPY, default=LEVEL)
    crank_axes: SixPoints | None = quantity(
        -1000,
        1000,
        'about which each crank turns by the right hand, base frame, of any length; without them '
        'every crank turns in the vertical plane of its tangent',
        default=None,
    )

    def geometry(self) -> RotaryGeometry:
        """The same joints in metres; ConfigError as `RotaryGeometry`."""
        return RotaryGeometry(
            crank_centres=np.array(self.crank_centres_mm) * 1e-3,
            tangents=np.array(self.crank_tangents),
            platform_points=np.array(self.platform_joints_mm) * 1e-3,
            crank_lengths=np.asarray(self.crank_length_mm) * 1e-3,
            rod_lengths=np.asarray(self.rod_length_mm) * 1e-3,
            home_height=self.home_height_mm * 1e-3,
            normals=self._normals(),
            **at_home(self.home_xy_mm, self.home_rpy_deg),
        )

    def _normals(self) -> Array:
        if self.crank_axes is None:
            return VERTICAL_PLANES
        return unit_vectors(self.crank_axes, 'crank_axes')


def _around(radial: Array, along: Array, height: Array) -> Array:
    """Points (6, 3) given by their leg's radial, tangential and vertical coordinates."""
    turn = np.arange(LEGS) * np.pi / 3
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.stack([cosine * radial - sine * along, sine * radial + cosine * along, height], 1)


SAMPLES = 24
LEAST_SIGMA = 1e-7


def architecture_sigma(base_points: Array, platform_points: Array) -> float:
    """The largest σmin of the leg Jacobian over a fixed set of poses: 0 if always singular.

    base_points (6, 3) or (k, 6, 3), as for k settings of the cranks, in the base frame;
    platform_points (6, 3) in the platform frame; rotations scaled by the platform's rms radius.
    The samples are general poses, turned by up to 1 rad about each axis and shifted by up to half
    the base's radius: a regular architecture is singular on a surface at most, which these miss.
    """
    base = np.reshape(base_points, (-1, 1, 6, 3))
    centre = platform_points.mean(axis=0)
    size = _radius(platform_points)
    random = np.random.default_rng(3)
    rotation = so3.exp(random.uniform(-1.0, 1.0, (SAMPLES, 3)))
    low, high = (-0.5, -0.5, 0.7), (0.5, 0.5, 2.5)
    shift = random.uniform(low, high, (SAMPLES, 3)) * _radius(base[0, 0])
    poses = Pose(base[:, 0].mean(axis=1)[:, None] + shift, np.stack([rotation] * len(base)))
    jacobian = leg_jacobian(base, platform_points - centre, poses)
    return float(np.max(smallest_singular_value(jacobian, size)))


def check_architecture(base_points: Array, platform_points: Array) -> None:
    """Raises ConfigError where the leg Jacobian is singular in every sampled pose.

    The shapes are those of `architecture_sigma`. The best known case is a platform whose hexagon
    is similar to the base's, as in Lapikov et al. 2014, section 4, where φb = φmp.
    """
    if _radius(platform_points) == 0.0 or architecture_sigma(base_points, platform_points) < (
        LEAST_SIGMA
    ):
        raise ConfigError(
            [
                'the joints of base and platform are placed so that no leg lengths fix a pose: '
                'the platform can give way without any leg changing its length, wherever it '
                'stands (as when both hexagons are similar; give them different joint angles)'
            ]
        )


def _radius(points: Array) -> float:
    """The points' rms distance from their centroid."""
    return float(np.sqrt(np.mean(np.sum((points - points.mean(axis=0)) ** 2, axis=-1))))
