"""The `limits` sections of machine files: of each kind of parallel platform.

Passive joints are limited as docs/kinematics.md, section 6, says: a rod end turns freely about
its bolt, and tilts only as far as its housing lets it.
"""

from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS, Range, SixRanges
from hexapod_control.linear import LinearPlatform
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.platform_limits import (
    HEIGHT,
    JOINT,
    LEANING,
    SHORTFALL,
    SIGMA,
    SURPLUS,
    SWING,
    TILT,
)
from hexapod_control.rails import RailPlatform
from hexapod_control.rotary import RotaryHexapod
from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, SIZE_MM, quantity
from manipulator.errors import ConfigError
from manipulator.limits.constraints import Constraints
from manipulator.limits.limit import GroupedLimit
from manipulator.limits.machine_limits import BodyHeight, JointRange

SINGULARITY_MARGIN = 'smallest singular value of the leg Jacobian (docs/kinematics.md, 5)'
CHARACTERISTIC_LENGTH = 'what one radian counts in that Jacobian: about the radius of the platform'
LEG_NAMES = tuple(f'leg {leg}' for leg in range(1, LEGS + 1))


def rod_closure(kinematics: ParallelPlatform, is_surplus: bool = False) -> GroupedLimit:
    """How much too short (or too long) each rod is to close its leg, in metres: at most 0.

    Depends on the pose alone and so has a value where the joints have none.
    """
    name, columns = ('rod surplus', SURPLUS) if is_surplus else ('rod shortfall', SHORTFALL)
    return _each_leg(kinematics, columns, name, 'm', -np.inf, 0.0)


def crank_joint_tilt(kinematics: RotaryHexapod, largest: float) -> GroupedLimit:
    """The change (rad) since home of the rod's angle to the plane in which its crank turns.

    The bolt of this joint is parallel to the servo's axis, about which the rod turns freely.
    """
    return _each_leg(kinematics, TILT, 'crank joint tilt', 'rad', -largest, largest)


def platform_joint_swing(kinematics: ParallelPlatform, largest: float) -> GroupedLimit:
    """The rod's angle (rad) to its direction at home, as the platform sees it: a cone."""
    return _each_leg(kinematics, SWING, 'platform joint swing', 'rad', -np.inf, largest)


def base_joint_swing(kinematics: ParallelPlatform, largest: float) -> GroupedLimit:
    """The rod's angle (rad) to its direction at home, as the base sees it: a cone."""
    return _each_leg(kinematics, LEANING, 'base joint swing', 'rad', -np.inf, largest)


def singularity_margin(kinematics: ParallelPlatform, minimum: float) -> GroupedLimit:
    """The kinematics' σmin at least `minimum` (dimensionless)."""
    low, high = frozen([minimum]), frozen([np.inf])
    return GroupedLimit(kinematics.limits, SIGMA, 'singularity margin', '', ('',), low, high)


def _each_leg(
    kinematics: ParallelPlatform, columns: slice, quantity: str, unit: str, low: float, high: float
) -> GroupedLimit:
    bounds = (frozen(np.full(LEGS, end)) for end in (low, high))
    return GroupedLimit(kinematics.limits, columns, quantity, unit, LEG_NAMES, *bounds)


def _of_legs(ranges: Range | SixRanges) -> Array:
    """Where each leg's range begins, and where it ends: (2, 6)."""
    ends: Array = np.broadcast_to(np.asarray(ranges, dtype=np.float64), (LEGS, 2)).T
    return ends


def _check_ranges(
    key: str, ranges: Range | SixRanges, widest: float = np.inf, within: str = ''
) -> None:
    """Raises ConfigError with every range that is empty, or wider than `widest`."""
    rows = np.atleast_2d(ranges)
    problems = [
        f'{key}{f"[{leg}]" if len(rows) > 1 else ""}: [{low:g}, {high:g}] is no range{within}'
        for leg, (low, high) in enumerate(rows)
        if not 0.0 < high - low <= widest
    ]
    if problems:
        raise ConfigError(problems)


@dataclass(frozen=True)
class RotaryLimits:
    """What a crank hexapod may not exceed, in the units of its machine file.

    crank_range_deg is one range for all cranks, or one for each.
    """

    crank_range_deg: Range | SixRanges = quantity(
        -360, 720, 'travel of every crank, from its tangent towards up, or of each'
    )
    minimum_height_mm: float = quantity(*PLACE_MM, "of the platform frame's origin, base frame")
    platform_joint_swing_deg: float = quantity(
        1e-3, 180, "a rod's from its direction at home, seen from the platform"
    )
    crank_joint_tilt_deg: float = quantity(
        1e-3, 90, "a rod's out of its crank's plane, change since home"
    )
    singularity_margin: float = quantity(1e-3, 2, SINGULARITY_MARGIN)
    characteristic_length_mm: float = quantity(*SIZE_MM, CHARACTERISTIC_LENGTH)

    def __post_init__(self) -> None:
        """Raises ConfigError for crank ranges that are empty or more than a turn."""
        _check_ranges('crank_range_deg', self.crank_range_deg, 360.0, ' within a turn')

    @property
    def crank_ranges(self) -> tuple[Array, Array]:
        """Where each crank's range begins and ends, (6,) each, in radians."""
        low, high = np.radians(_of_legs(self.crank_range_deg))
        return low, high

    @property
    def crank_middles(self) -> Array:
        """The middle of each crank's range (6,), in radians."""
        low, high = self.crank_ranges
        middles: Array = (low + high) / 2
        return middles

    def constraints(self, kinematics: RotaryHexapod) -> Constraints:
        """The limits, cheapest first."""
        low, high = self.crank_ranges
        return Constraints(
            (
                rod_closure(kinematics),
                rod_closure(kinematics, is_surplus=True),
                JointRange(
                    low,
                    high,
                    LEG_NAMES,
                    'crank angle',
                    group=kinematics.limits,
                    columns=JOINT,
                ),
                BodyHeight(self.minimum_height_mm * 1e-3, group=kinematics.limits, columns=HEIGHT),
                crank_joint_tilt(kinematics, float(np.radians(self.crank_joint_tilt_deg))),
                platform_joint_swing(kinematics, float(np.radians(self.platform_joint_swing_deg))),
                singularity_margin(kinematics, self.singularity_margin),
            )
        )


@dataclass(frozen=True)
class LinearLimits:
    """What a linear platform may not exceed, in the units of its machine file.

    A stroke is a leg's length between its joint centres: one range for all legs, or one for each.
    The passive cone is how far a leg may swing, at either end, from its direction at home.
    """

    stroke_range_mm: Range | SixRanges = quantity(
        *SIZE_MM, "of every leg's length, between its joints, or of each"
    )
    passive_cone_deg: float = quantity(
        1e-3, 180, "a leg's swing from its direction at home, at either end"
    )
    singularity_margin: float = quantity(1e-3, 2, SINGULARITY_MARGIN)
    characteristic_length_mm: float = quantity(*SIZE_MM, CHARACTERISTIC_LENGTH)

    def __post_init__(self) -> None:
        """Raises ConfigError for strokes that are empty."""
        _check_ranges('stroke_range_mm', self.stroke_range_mm)

    def constraints(self, kinematics: LinearPlatform) -> Constraints:
        """The limits, cheapest first."""
        low, high = 1e-3 * _of_legs(self.stroke_range_mm)
        cone = float(np.radians(self.passive_cone_deg))
        return Constraints(
            (
                JointRange(
                    low, high, LEG_NAMES, 'leg length', 'm', group=kinematics.limits, columns=JOINT
                ),
                base_joint_swing(kinematics, cone),
                platform_joint_swing(kinematics, cone),
                singularity_margin(kinematics, self.singularity_margin),
            )
        )


@dataclass(frozen=True)
class RailLimits:
    """What a platform on rails may not exceed, in the units of its machine file.

    The rail range is of the carriages' positions: one for all, or one for each. The passive cone
    is how far a strut may swing, at either end, from its direction at home.
    """

    rail_range_mm: Range | SixRanges = quantity(
        *PLACE_MM, "of every carriage's position, or of each"
    )
    passive_cone_deg: float = quantity(
        1e-3, 180, "a strut's swing from its direction at home, at either end"
    )
    singularity_margin: float = quantity(1e-3, 2, SINGULARITY_MARGIN)
    characteristic_length_mm: float = quantity(*SIZE_MM, CHARACTERISTIC_LENGTH)

    def __post_init__(self) -> None:
        """Raises ConfigError for ranges that are empty."""
        _check_ranges('rail_range_mm', self.rail_range_mm)

    @property
    def rail_ranges(self) -> tuple[Array, Array]:
        """Where each carriage's range begins and ends, (6,) each, in metres."""
        low, high = 1e-3 * _of_legs(self.rail_range_mm)
        return low, high

    def constraints(self, kinematics: RailPlatform) -> Constraints:
        """The limits, cheapest first."""
        low, high = self.rail_ranges
        cone, group = float(np.radians(self.passive_cone_deg)), kinematics.limits
        names, columns = LEG_NAMES, JOINT
        return Constraints(
            (
                rod_closure(kinematics),
                JointRange(
                    low, high, names, 'carriage position', 'm', group=group, columns=columns
                ),
                base_joint_swing(kinematics, cone),
                platform_joint_swing(kinematics, cone),
                singularity_margin(kinematics, self.singularity_margin),
            )
        )
