"""A platform on struts whose lower ends slide on rails, as a `Kinematics`: positions, one pose."""

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from hexapod_control.geometry import (
    HOME_HEIGHT,
    HOME_RPY,
    HOME_XY,
    LEGS,
    LEVEL,
    ORIGIN,
    PLATFORM_JOINTS,
    ROD_LENGTH,
    AtHome,
    Range,
    SixPoints,
    Triple,
    at_home,
    unit_vectors,
)
from hexapod_control.legs import LegKind, Legs
from hexapod_control.parallel_platform import ParallelPlatform
from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, SIZE_MM, TURN_DEG, key, quantity
from manipulator.links import Stroke
from manipulator.motion_limits import SixNumbers
from manipulator.pose import Pose

Side = Literal['behind', 'ahead']


@dataclass(frozen=True, eq=False)
class RailGeometry(AtHome):
    """Six rails and struts in metres; see docs/kinematics.md, section 10.

    Carriage i at position q has the lower end of its strut at rail_points[i] + q directions[i]
    (base frame); the upper one is at platform_points[i] (platform frame). sides[i] is 1 where the
    carriage stands behind its platform joint along the rail, −1 where it is ahead. home_height is
    the platform's height at home, see `AtHome`. ConfigError names directions that are none.
    """

    rail_points: Array
    directions: Array
    platform_points: Array
    rod_lengths: Array
    sides: Array
    home_height: float

    @property
    def home(self) -> Pose:
        """T_base_platform at home."""
        return self.home_at(self.home_height)

    def __post_init__(self) -> None:
        """Makes directions unit vectors, and lengths and sides six."""
        directions = unit_vectors(self.directions, 'rail_directions')
        object.__setattr__(self, 'directions', frozen(directions))
        for name in ('rail_points', 'platform_points'):
            object.__setattr__(self, name, frozen(getattr(self, name)))
        for name in ('rod_lengths', 'sides'):
            six = np.broadcast_to(np.asarray(getattr(self, name), dtype=np.float64), LEGS)
            object.__setattr__(self, name, frozen(six))


@dataclass(frozen=True)
class RailsConfig:
    """The `geometry` section of a platform on rails, in millimetres.

    rail_points_mm are where the struts' lower joints are with the carriages at position 0;
    rail_directions (no unit, any length) point to where positions grow. carriages, one word or
    six: behind their platform joints, along the rails' directions, or ahead of them.
    """

    rail_points_mm: SixPoints = quantity(
        *PLACE_MM, "the struts' lower joints with the carriages at position 0, base frame"
    )
    rail_directions: SixPoints = quantity(
        -1000, 1000, 'to where positions of the carriages grow, base frame; of any length'
    )
    platform_joints_mm: SixPoints = quantity(*PLACE_MM, PLATFORM_JOINTS)
    rod_length_mm: float | SixNumbers = quantity(*SIZE_MM, ROD_LENGTH)
    home_height_mm: float = quantity(*PLACE_MM, HOME_HEIGHT)
    home_xy_mm: Range = quantity(*PLACE_MM, HOME_XY, default=ORIGIN)
    home_rpy_deg: Triple = quantity(*TURN_DEG, HOME_RPY, default=LEVEL)
    carriages: Side | tuple[Side, Side, Side, Side, Side, Side] = key(
        "behind or ahead of the platform's joints, in the rails' directions; one word, or six",
        default='behind',
    )

    def geometry(self) -> RailGeometry:
        """The same rails in metres; ConfigError as `RailGeometry`."""
        return RailGeometry(
            rail_points=np.array(self.rail_points_mm) * 1e-3,
            directions=np.array(self.rail_directions),
            platform_points=np.array(self.platform_joints_mm) * 1e-3,
            rod_lengths=np.asarray(self.rod_length_mm) * 1e-3,
            sides=np.where(np.array(self.carriages) == 'behind', 1.0, -1.0),
            home_height=self.home_height_mm * 1e-3,
            **at_home(self.home_xy_mm, self.home_rpy_deg),
        )


@dataclass(frozen=True, eq=False)
class RailPlatform(ParallelPlatform):
    """Kinematics of a platform on rails; a joint is a carriage's position in metres.

    Carriages stand on the side of their platform joints that the geometry says, unless joints to
    stay near are nearer on the other. travel, (6,) each in metres, is from where to where rails
    are drawn. Construction as of `ParallelPlatform`.
    """

    geometry: RailGeometry
    travel: tuple[Array, Array]
    powerless: ClassVar[str] = 'a rod is square to its rail'

    @property
    def joint_names(self) -> tuple[str, ...]:
        """carriage_1 to carriage_6."""
        return tuple(f'carriage_{leg}' for leg in range(1, LEGS + 1))

    @property
    def joint_unit(self) -> str:
        """Metres."""
        return 'm'

    @property
    def rail_ends(self) -> Array:
        """Where the carriages' joints are at either end of travel, (6, 2, 3), base frame."""
        return np.stack([self.base_points(ends) for ends in self.travel], axis=1)

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """Six rails, six rods, the platform's outline."""
        _, *others = super().skeleton(pose, joints)
        return *(Stroke('body', ends) for ends in self.rail_ends), *others

    def _legs(self) -> Legs:
        g, zero = self.geometry, np.zeros((LEGS, 3))
        return Legs.of(
            LegKind.RAIL,
            g.rail_points,
            g.platform_points,
            axes=(zero, g.sides[:, None] * g.directions, zero),
            cranks=g.sides,
            rods=g.rod_lengths,
        )
