"""Where the joints of a linear platform are: the paper's parameters or explicit coordinates."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import (
    HOME_HEIGHT,
    HOME_RPY,
    HOME_XY,
    LEGS,
    LEVEL,
    ORIGIN,
    PLATFORM_JOINTS,
    AtHome,
    Range,
    SixPoints,
    Triple,
    at_home,
    check_architecture,
)
from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, SIZE_MM, TURN_DEG, quantity
from manipulator.errors import InvalidInput
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class LinearGeometry(AtHome):
    """Joint centres (6, 3) in metres: base_points in the base frame, platform_points in its own.

    home_height is the platform's height at home, see `AtHome`.
    """

    base_points: Array
    platform_points: Array
    home_height: float

    @property
    def home(self) -> Pose:
        """T_base_platform at home."""
        return self.home_at(self.home_height)

    def __post_init__(self) -> None:
        """Freezes the points; raises InvalidInput on any other shape."""
        for name in ('base_points', 'platform_points'):
            points = frozen(getattr(self, name))
            if points.shape != (LEGS, 3):
                raise InvalidInput(f'{name} have shape {points.shape}, need ({LEGS}, 3)')
            object.__setattr__(self, name, points)


@dataclass(frozen=True)
class PlatesConfig:
    """The `geometry` section by the parameters of Lapikov et al. 2014, section 3.

    Six joints on a circle of each plate, at the angles φ, 2π/3 − φ, 2π/3 + φ, 4π/3 − φ, 4π/3 + φ,
    −φ (eqs 2 and 3). A platform angle of 0 joins them in pairs: the 6-3. 30° spaces them evenly.
    The joint heights are from each plate's plane to its joints, towards the other plate.
    """

    base_radius_mm: float = quantity(*SIZE_MM, "R: circle of the base's joints")
    base_angle_deg: float = quantity(0, 60, 'φb: from the x axis to the first joint')
    platform_radius_mm: float = quantity(*SIZE_MM, "r: circle of the platform's joints")
    platform_angle_deg: float = quantity(0, 60, 'φmp, likewise; 0 joins them in pairs')
    base_joint_height_mm: float = quantity(0, PLACE_MM[1], 'h_b: joints above the base plate')
    platform_joint_height_mm: float = quantity(
        0, PLACE_MM[1], 'h_mp: joints below the platform plate'
    )
    home_height_mm: float = quantity(*PLACE_MM, HOME_HEIGHT)
    home_xy_mm: Range = quantity(*PLACE_MM, HOME_XY, default=ORIGIN)
    home_rpy_deg: Triple = quantity(*TURN_DEG, HOME_RPY, default=LEVEL)

    def geometry(self) -> LinearGeometry:
        """The joints in metres; ConfigError where no leg lengths fix a pose."""
        base = joint_circle(self.base_radius_mm, np.radians(self.base_angle_deg))
        platform = joint_circle(self.platform_radius_mm, np.radians(self.platform_angle_deg))
        base[:, 2] = self.base_joint_height_mm
        platform[:, 2] = -self.platform_joint_height_mm
        home = at_home(self.home_xy_mm, self.home_rpy_deg)
        return _checked(base, platform, self.home_height_mm, home)


@dataclass(frozen=True)
class PointsConfig:
    """The `geometry` section by coordinates, in millimetres: a machine as it was measured."""

    base_joints_mm: SixPoints = quantity(*PLACE_MM, "the legs' joints on the base, base frame")
    platform_joints_mm: SixPoints = quantity(*PLACE_MM, PLATFORM_JOINTS)
    home_height_mm: float = quantity(*PLACE_MM, HOME_HEIGHT)
    home_xy_mm: Range = quantity(*PLACE_MM, HOME_XY, default=ORIGIN)
    home_rpy_deg: Triple = quantity(*TURN_DEG, HOME_RPY, default=LEVEL)

    def geometry(self) -> LinearGeometry:
        """The joints in metres; ConfigError where no leg lengths fix a pose."""
        base, platform = np.array(self.base_joints_mm), np.array(self.platform_joints_mm)
        home = at_home(self.home_xy_mm, self.home_rpy_deg)
        return _checked(base, platform, self.home_height_mm, home)


def joint_circle(radius: float, first_angle: float) -> Array:
    """Six joints (6, 3) at z = 0, by Lapikov et al. 2014, eqs (2) and (3); angle in radians."""
    third = 2 * np.pi / 3
    angles = np.repeat([0.0, third, 2 * third, 0.0], [1, 2, 2, 1])
    angles += first_angle * np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    return radius * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(LEGS)])


def _checked(
    base_mm: Array, platform_mm: Array, home_height_mm: float, home: dict[str, Array]
) -> LinearGeometry:
    height = home_height_mm * 1e-3
    geometry = LinearGeometry(base_mm * 1e-3, platform_mm * 1e-3, height, **home)
    check_architecture(geometry.base_points, geometry.platform_points)
    return geometry
