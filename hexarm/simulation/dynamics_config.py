"""The `dynamics` section of a machine file: masses, inertias and drives, each with its source.

`source` is a text: where a number comes from, or 'estimate'.
"""

import math
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, SIZE_MM, key, quantity
from manipulator.errors import ConfigError
from manipulator.frames import ToolConfig

Three = tuple[float, float, float]
SOURCE = "where the numbers come from, or 'estimate'"
INERTIA = 'principal moments about the centre of mass, along the axes'
COMPENSATION = 'whether targets are corrected by the static deflection of the drives'
GRAVITY = 9.80665
"""m/s², on Earth."""

GRAVITY_DIRECTION = (
    "of gravity, base frame, of any length: 0, 0, 1 where the base frame's z points down; a home "
    'below an upright base needs no other'
)
MASS_G = (1e-3, 1e9)
EFFORT = (1e-6, 1e8)
"""N or N·m."""

LARGEST_GYRATION_MM = 2e4
SMALLEST_GYRATION_MM = 0.01
NONE: Three = (0.0, 0.0, 0.0)


def tensor(moments: Three, products: Three) -> Array:
    """The inertia tensor (3, 3) of its moments, and of its products xy, xz, yz."""
    (xx, yy, zz), (xy, xz, yz) = moments, products
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def check_inertia(mass_g: float, inertia_g_mm2: Three, products_g_mm2: Three = NONE) -> None:
    """Raises ConfigError for moments, and products xy, xz, yz, that no body of this mass has."""
    problems = []
    if products_g_mm2 != NONE:
        inertia_g_mm2 = np.linalg.eigvalsh(tensor(inertia_g_mm2, products_g_mm2)).tolist()
    a, b, c = sorted(inertia_g_mm2)
    if c > (a + b) * (1 + 1e-9):
        problems.append(
            f'inertia_g_mm2: {c:g} is more than {a:g} + {b:g}: no body has such moments '
            '(each is at most the sum of the other two)'
        )
    low, high = (mass_g * k**2 for k in (SMALLEST_GYRATION_MM, LARGEST_GYRATION_MM))
    for moment in inertia_g_mm2:
        if not low <= moment <= high:
            radius = math.sqrt(max(moment, 0.0) / mass_g)
            problems.append(
                f'inertia_g_mm2: {moment:g} with {mass_g:g} g is a radius of gyration of '
                f'{radius:.3g} mm, outside [{SMALLEST_GYRATION_MM:g}, {LARGEST_GYRATION_MM:g}]'
            )
    if problems:
        raise ConfigError(problems)


@dataclass(frozen=True)
class PlateConfig:
    """The platform: a hexagonal plate about its joints, unless centre and inertia are given.

    centre_mm in the platform frame; inertia_g_mm2 about the centre, principal along its axes.
    """

    source: str = key(SOURCE)
    mass_g: float = quantity(*MASS_G, 'of the plate')
    thickness_mm: float = quantity(*SIZE_MM, 'of the plate')
    centre_mm: Three = quantity(*PLACE_MM, 'of mass, platform frame', default=(0.0, 0.0, 0.0))
    inertia_g_mm2: Three | None = quantity(0, 1e18, INERTIA, default=None)

    def __post_init__(self) -> None:
        """Raises ConfigError for impossible moments."""
        if self.inertia_g_mm2 is not None:
            check_inertia(self.mass_g, self.inertia_g_mm2)


@dataclass(frozen=True)
class PayloadConfig:
    """What is carried: a cylinder on the moving frame's xy plane; 0 g is nothing."""

    source: str = key(SOURCE)
    mass_g: float = quantity(0, MASS_G[1], '0 is nothing')
    radius_mm: float = quantity(*SIZE_MM, 'of a cylinder')
    height_mm: float = quantity(*SIZE_MM, 'of the cylinder')


@dataclass(frozen=True)
class CarriedConfig(PayloadConfig):
    """The payload of a file, and the tool that is on the machine as well; no section of a file."""

    tool: ToolConfig = key('that weighs something')


@dataclass(frozen=True)
class RodConfig:
    """A round rod of even density; its length is the mechanism's."""

    source: str = key(SOURCE)
    mass_g: float = quantity(*MASS_G, 'of one')
    radius_mm: float = quantity(*SIZE_MM, 'of one')


@dataclass(frozen=True)
class TubeConfig:
    """A part of a leg that is as long as it says: a round rod of even density."""

    source: str = key(SOURCE)
    mass_g: float = quantity(*MASS_G, 'of one')
    radius_mm: float = quantity(*SIZE_MM, 'of one')
    length_mm: float = quantity(*SIZE_MM, 'of one')


@dataclass(frozen=True)
class TurningDriveConfig:
    """A servo that turns: torque at standstill, and at which error it gives all of it.

    backdrive_n_m is what its gears hold without power; rotor_inertia_g_mm2 as felt at the output.
    Its free speed is in the section `servos`.
    """

    source: str = key(SOURCE)
    torque_n_m: float = quantity(*EFFORT, 'at standstill')
    proportional_band_deg: float = quantity(
        1e-6, 90, 'error at which the motor gets its whole voltage'
    )
    backdrive_n_m: float = quantity(0, EFFORT[1], 'what the gears hold without power')
    rotor_inertia_g_mm2: float = quantity(1e-3, 1e18, 'as felt at the output')


@dataclass(frozen=True)
class PushingDriveConfig:
    """A servo that pushes, as `TurningDriveConfig`; rotor_mass_g as felt at the output."""

    source: str = key(SOURCE)
    force_n: float = quantity(*EFFORT, 'at standstill')
    proportional_band_mm: float = quantity(
        1e-6, 1000, 'error at which the motor gets its whole voltage'
    )
    backdrive_n: float = quantity(0, EFFORT[1], 'what the gears hold without power')
    rotor_mass_g: float = quantity(MASS_G[0], 1e12, 'as felt at the output')


@dataclass(frozen=True, kw_only=True)
class GravityConfig:
    """Where gravity pulls, for every kind of machine."""

    gravity_direction: Three = quantity(-1000, 1000, GRAVITY_DIRECTION, default=(0.0, 0.0, -1.0))

    def __post_init__(self) -> None:
        """Raises ConfigError for a direction that is none."""
        if not np.linalg.norm(self.gravity_direction) > 0.0:
            raise ConfigError([f'gravity_direction: {list(self.gravity_direction)} is none'])

    @property
    def gravity(self) -> Array:
        """The acceleration of free fall, (3,) m/s², base frame."""
        direction = np.array(self.gravity_direction)
        return frozen(GRAVITY * direction / np.linalg.norm(direction))


@dataclass(frozen=True, kw_only=True)
class DynamicsConfig(GravityConfig):
    """What the section has for every machine with masses and drives of its own."""

    compensation: bool = key(COMPENSATION, default=False)


@dataclass(frozen=True)
class PlatformDynamicsConfig(DynamicsConfig):
    """What every parallel platform moves beside its legs."""

    platform: PlateConfig = key('a hexagonal plate about its joints')
    payload: PayloadConfig = key('what is carried, on the xy plane of the moving frame')


@dataclass(frozen=True)
class RotaryDynamicsConfig(PlatformDynamicsConfig):
    """A crank platform's masses and drives."""

    crank: RodConfig = key('every crank, a round rod')
    rod: RodConfig = key('every rod, round')
    servo: TubeConfig = key('every servo, drawn as a cylinder')
    drive: TurningDriveConfig = key('a servo that turns')


@dataclass(frozen=True)
class LinearDynamicsConfig(PlatformDynamicsConfig):
    """A linear platform's masses and drives: a leg is a cylinder below and a piston above."""

    cylinder: TubeConfig = key('lower part of every leg')
    piston: TubeConfig = key('upper part of every leg')
    drive: PushingDriveConfig = key('a servo that pushes')


@dataclass(frozen=True)
class RailDynamicsConfig(PlatformDynamicsConfig):
    """The masses and drives of a platform on rails; a carriage's length is along its rail."""

    carriage: TubeConfig = key('every carriage, drawn as a cylinder along its rail')
    rod: RodConfig = key('every rod, round')
    drive: PushingDriveConfig = key('a servo that pushes')


@dataclass(frozen=True)
class LinkConfig:
    """A link and the drive that turns it: a round rod from its joint to the next, unless given.

    centre_mm, inertia_g_mm2 (moments about the centre) and products_g_mm2 (xy, xz, yz) in base
    axes at zero angles.
    """

    source: str = key(SOURCE)
    drive: TurningDriveConfig = key('a servo that turns')
    mass_g: float = quantity(*MASS_G, 'of one')
    radius_mm: float = quantity(*SIZE_MM, 'of a round rod to the next joint')
    centre_mm: Three | None = quantity(
        *PLACE_MM, 'of mass, base axes at zero angles', default=None
    )
    inertia_g_mm2: Three | None = quantity(
        0, 1e18, 'moments about the centre of mass, base axes at zero angles', default=None
    )
    products_g_mm2: Three = quantity(-1e18, 1e18, 'products of inertia xy, xz, yz', default=NONE)

    def __post_init__(self) -> None:
        """Raises ConfigError for impossible moments."""
        if self.inertia_g_mm2 is not None:
            check_inertia(self.mass_g, self.inertia_g_mm2, self.products_g_mm2)
        elif self.products_g_mm2 != NONE:
            raise ConfigError(['products_g_mm2: without inertia_g_mm2'])


@dataclass(frozen=True)
class ArmDynamicsConfig(DynamicsConfig):
    """A serial arm's links, base first, and what its tool carries."""

    links: tuple[LinkConfig, LinkConfig, LinkConfig, LinkConfig, LinkConfig, LinkConfig] = key(
        'base first'
    )
    payload: PayloadConfig = key('what is carried, on the xy plane of the moving frame')


@dataclass(frozen=True)
class StackDynamicsConfig(GravityConfig):
    """A stack has no masses and drives but those of its sections; gravity is its own."""


Dynamics = RotaryDynamicsConfig | LinearDynamicsConfig | RailDynamicsConfig | ArmDynamicsConfig

SCHEMAS: dict[str, type[Dynamics]] = {
    'rotary_hexapod': RotaryDynamicsConfig,
    'linear_hexapod': LinearDynamicsConfig,
    'rail_hexapod': RailDynamicsConfig,
    'serial_arm': ArmDynamicsConfig,
}
"""What the section must hold, by the machine's kind."""
