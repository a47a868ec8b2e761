"""The `dynamics` section of a machine file: masses, inertias and drives, each with its source.

`source` is a text: where a number comes from, or 'estimate'.
"""

import math
from dataclasses import dataclass

from manipulator.config import quantity
from manipulator.errors import ConfigError

Three = tuple[float, float, float]
LARGEST_GYRATION_MM = 2000.0
SMALLEST_GYRATION_MM = 0.1


def check_inertia(mass_g: float, inertia_g_mm2: Three) -> None:
    """Raises ConfigError for moments that no body of this mass has."""
    problems = []
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

    source: str
    mass_g: float = quantity(0.1, 1e6)
    thickness_mm: float = quantity(0.1, 500)
    centre_mm: Three = quantity(-1000, 1000, default=(0.0, 0.0, 0.0))
    inertia_g_mm2: Three | None = quantity(0, 1e13, default=None)

    def __post_init__(self) -> None:
        """Raises ConfigError for impossible moments."""
        if self.inertia_g_mm2 is not None:
            check_inertia(self.mass_g, self.inertia_g_mm2)


@dataclass(frozen=True)
class PayloadConfig:
    """What is carried: a cylinder on the moving frame's xy plane; 0 g is nothing."""

    source: str
    mass_g: float = quantity(0, 1e6)
    radius_mm: float = quantity(0.5, 1000)
    height_mm: float = quantity(0.5, 1000)


@dataclass(frozen=True)
class RodConfig:
    """A round rod of even density; its length is the mechanism's."""

    source: str
    mass_g: float = quantity(0.01, 1e6)
    radius_mm: float = quantity(0.1, 500)


@dataclass(frozen=True)
class TubeConfig:
    """A part of a leg that is as long as it says: a round rod of even density."""

    source: str
    mass_g: float = quantity(0.01, 1e6)
    radius_mm: float = quantity(0.1, 500)
    length_mm: float = quantity(1, 5000)


@dataclass(frozen=True)
class TurningDriveConfig:
    """A servo that turns: torque at standstill, and at which error it gives all of it.

    backdrive_n_m is what its gears hold without power; rotor_inertia_g_mm2 as felt at the output.
    Its free speed is in the section `servos`.
    """

    source: str
    torque_n_m: float = quantity(0.001, 10_000)
    proportional_band_deg: float = quantity(0.01, 90)
    backdrive_n_m: float = quantity(0, 10_000)
    rotor_inertia_g_mm2: float = quantity(1, 1e11)


@dataclass(frozen=True)
class PushingDriveConfig:
    """A servo that pushes, as `TurningDriveConfig`; rotor_mass_g as felt at the output."""

    source: str
    force_n: float = quantity(0.01, 1e6)
    proportional_band_mm: float = quantity(0.001, 100)
    backdrive_n: float = quantity(0, 1e6)
    rotor_mass_g: float = quantity(0.1, 1e8)


@dataclass(frozen=True)
class RotaryDynamicsConfig:
    """A crank platform's masses and drives."""

    platform: PlateConfig
    payload: PayloadConfig
    crank: RodConfig
    rod: RodConfig
    servo: TubeConfig
    drive: TurningDriveConfig
    compensation: bool = False


@dataclass(frozen=True)
class LinearDynamicsConfig:
    """A linear platform's masses and drives: a leg is a cylinder below and a piston above."""

    platform: PlateConfig
    payload: PayloadConfig
    cylinder: TubeConfig
    piston: TubeConfig
    drive: PushingDriveConfig
    compensation: bool = False


@dataclass(frozen=True)
class RailDynamicsConfig:
    """The masses and drives of a platform on rails; a carriage's length is along its rail."""

    platform: PlateConfig
    payload: PayloadConfig
    carriage: TubeConfig
    rod: RodConfig
    drive: PushingDriveConfig
    compensation: bool = False


@dataclass(frozen=True)
class LinkConfig:
    """A link and the drive that turns it: a round rod from its joint to the next, unless told.

    centre_mm and inertia_g_mm2 (principal, about the centre) in base axes at zero angles.
    """

    source: str
    drive: TurningDriveConfig
    mass_g: float = quantity(0.1, 1e6)
    radius_mm: float = quantity(1, 1000)
    centre_mm: Three | None = quantity(-10_000, 10_000, default=None)
    inertia_g_mm2: Three | None = quantity(0, 1e13, default=None)

    def __post_init__(self) -> None:
        """Raises ConfigError for impossible moments."""
        if self.inertia_g_mm2 is not None:
            check_inertia(self.mass_g, self.inertia_g_mm2)


@dataclass(frozen=True)
class ArmDynamicsConfig:
    """A serial arm's links, base first, and what its tool carries."""

    links: tuple[LinkConfig, LinkConfig, LinkConfig, LinkConfig, LinkConfig, LinkConfig]
    payload: PayloadConfig
    compensation: bool = False


Dynamics = RotaryDynamicsConfig | LinearDynamicsConfig | RailDynamicsConfig | ArmDynamicsConfig

SCHEMAS: dict[str, type[Dynamics]] = {
    'rotary_hexapod': RotaryDynamicsConfig,
    'linear_hexapod': LinearDynamicsConfig,
    'rail_hexapod': RailDynamicsConfig,
    'serial_arm': ArmDynamicsConfig,
}
"""What the section must hold, by the machine's kind."""
