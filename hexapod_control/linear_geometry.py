"""Where the joints of a linear platform are: the paper's parameters or explicit coordinates."""

from dataclasses import dataclass, field, replace
from typing import Any

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
from manipulator.errors import ConfigError, InvalidInput
from manipulator.pose import Pose

NO_AXES = frozen(np.zeros((LEGS, 3)))


@dataclass(frozen=True, eq=False)
class LinearGeometry(AtHome):
    """Joint centres (6, 3) in metres: base_points in the base frame, platform_points in its own.

    home_height is the platform's height at home, see `AtHome`. screw_lead (metres a turn, 0
    for legs whose screws do not turn with their joints) comes with base_axes and platform_axes,
    the fixed axes of the cardan joints, each in the frame of its points.
    """

    base_points: Array
    platform_points: Array
    home_height: float
    screw_lead: float = 0.0
    base_axes: Array = field(default_factory=lambda: NO_AXES)
    platform_axes: Array = field(default_factory=lambda: NO_AXES)

    @property
    def home(self) -> Pose:
        """T_base_platform at home."""
        return self.home_at(self.home_height)

    def __post_init__(self) -> None:
        """Freezes the points; raises InvalidInput on any other shape."""
        for name in ('base_points', 'platform_points', 'base_axes', 'platform_axes'):
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
    base_joint_height_mm: float = quantity(
        0, PLACE_MM[1], "h_b: joints from the base's plate, towards the platform"
    )
    platform_joint_height_mm: float = quantity(
        0, PLACE_MM[1], "h_mp: joints from the platform's plate, towards the base"
    )
    home_height_mm: float = quantity(*PLACE_MM, HOME_HEIGHT)
    home_xy_mm: Range = quantity(*PLACE_MM, HOME_XY, default=ORIGIN)
    home_rpy_deg: Triple = quantity(*TURN_DEG, HOME_RPY, default=LEVEL)

    def geometry(self) -> LinearGeometry:
        """The joints in metres; ConfigError where no leg lengths fix a pose."""
        base = joint_circle(self.base_radius_mm, np.radians(self.base_angle_deg))
        platform = joint_circle(self.platform_radius_mm, np.radians(self.platform_angle_deg))
        towards = np.copysign(1.0, self.home_height_mm)
        base[:, 2] = towards * self.base_joint_height_mm
        platform[:, 2] = -towards * self.platform_joint_height_mm
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
    screw_lead_mm: float = quantity(
        *PLACE_MM,
        'of screws that turn with their cardan joints; right-hand: positive',
        default=0.0,
    )
    base_joint_axes: SixPoints | None = quantity(
        -1000, 1000, 'fixed axes of the cardan joints on the base, base frame', default=None
    )
    platform_joint_axes: SixPoints | None = quantity(
        -1000, 1000, 'fixed axes of those on the platform, platform frame', default=None
    )

    def __post_init__(self) -> None:
        """Raises ConfigError for screws without the axes of their joints."""
        missing = [
            f'{name}: missing, screw_lead_mm is {self.screw_lead_mm:g}'
            for name in ('base_joint_axes', 'platform_joint_axes')
            if self.screw_lead_mm != 0.0 and getattr(self, name) is None
        ]
        if missing:
            raise ConfigError(missing)

    def geometry(self) -> LinearGeometry:
        """The joints in metres; ConfigError where no leg lengths fix a pose."""
        base, platform = np.array(self.base_joints_mm), np.array(self.platform_joints_mm)
        home = at_home(self.home_xy_mm, self.home_rpy_deg)
        plain = _checked(base, platform, self.home_height_mm, home)
        if self.screw_lead_mm == 0.0:
            return plain
        axes = np.array(self.base_joint_axes), np.array(self.platform_joint_axes)
        lead = self.screw_lead_mm * 1e-3
        return replace(plain, screw_lead=lead, base_axes=axes[0], platform_axes=axes[1])


def joint_circle(radius: float, first_angle: float) -> Array:
    """Six joints (6, 3) at z = 0, by Lapikov et al. 2014, eqs (2) and (3); angle in radians."""
    third = 2 * np.pi / 3
    angles = np.repeat([0.0, third, 2 * third, 0.0], [1, 2, 2, 1])
    angles += first_angle * np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    return radius * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(LEGS)])


def _checked(
    base_mm: Array, platform_mm: Array, home_height_mm: float, home: dict[str, Any]
) -> LinearGeometry:
    height = home_height_mm * 1e-3
    geometry = LinearGeometry(base_mm * 1e-3, platform_mm * 1e-3, height, **home)
    check_architecture(geometry.base_points, geometry.platform_points)
    return geometry
