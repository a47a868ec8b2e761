"""The `limits` sections of machine files: of crank hexapods and of linear platforms."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.linear import LinearPlatform
from hexapod_control.passive_joints import (
    LEG_NAMES,
    BaseJointSwing,
    CrankJointTilt,
    PlatformJointSwing,
)
from hexapod_control.rotary import RotaryHexapod
from manipulator.config import quantity
from manipulator.errors import ConfigError
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import BodyHeight, JointRange, RodClosure, SingularityMargin


@dataclass(frozen=True)
class RotaryLimits:
    """What a crank hexapod may not exceed, in the units of its machine file."""

    crank_range_deg: tuple[float, float] = quantity(-360, 720)
    minimum_height_mm: float = quantity(-3000, 3000)
    platform_joint_swing_deg: float = quantity(1, 180)
    crank_joint_tilt_deg: float = quantity(1, 90)
    singularity_margin: float = quantity(0.001, 2)
    characteristic_length_mm: float = quantity(1, 3000)

    def __post_init__(self) -> None:
        """Raises ConfigError for a crank range that is empty or more than a turn."""
        low, high = self.crank_range_deg
        if not 0.0 < high - low <= 360.0:
            raise ConfigError([f'crank_range_deg: [{low:g}, {high:g}] is no range within a turn'])

    @property
    def crank_range(self) -> tuple[float, float]:
        """The crank range in radians."""
        low, high = np.radians(self.crank_range_deg)
        return float(low), float(high)

    @property
    def crank_centre(self) -> float:
        """The middle of the crank range, in radians."""
        return float(np.radians(sum(self.crank_range_deg) / 2))

    def constraints(self, kinematics: RotaryHexapod) -> Constraints:
        """The limits, cheapest first."""
        low, high = self.crank_range
        return Constraints(
            (
                RodClosure(kinematics.closure, LEG_NAMES),
                RodClosure(kinematics.closure, LEG_NAMES, is_surplus=True),
                JointRange(
                    np.full(len(LEG_NAMES), low),
                    np.full(len(LEG_NAMES), high),
                    LEG_NAMES,
                    'crank angle',
                ),
                BodyHeight(self.minimum_height_mm * 1e-3),
                CrankJointTilt(kinematics, float(np.radians(self.crank_joint_tilt_deg))),
                PlatformJointSwing(kinematics, float(np.radians(self.platform_joint_swing_deg))),
                SingularityMargin(kinematics, self.singularity_margin),
            )
        )


@dataclass(frozen=True)
class LinearLimits:
    """What a linear platform may not exceed, in the units of its machine file.

    A stroke is a leg's length between its joint centres. The passive cone is how far a leg may
    swing, at either end, from its direction at home.
    """

    stroke_range_mm: tuple[float, float] = quantity(1, 10_000)
    passive_cone_deg: float = quantity(1, 180)
    singularity_margin: float = quantity(0.001, 2)
    characteristic_length_mm: float = quantity(1, 3000)

    def __post_init__(self) -> None:
        """Raises ConfigError for a stroke that is empty."""
        low, high = self.stroke_range_mm
        if not low < high:
            raise ConfigError([f'stroke_range_mm: [{low:g}, {high:g}] is no range'])

    def constraints(self, kinematics: LinearPlatform) -> Constraints:
        """The limits, cheapest first."""
        low, high = (np.full(len(LEG_NAMES), 1e-3 * end) for end in self.stroke_range_mm)
        cone = float(np.radians(self.passive_cone_deg))
        return Constraints(
            (
                JointRange(low, high, LEG_NAMES, 'leg length', 'm'),
                BaseJointSwing(kinematics, cone),
                PlatformJointSwing(kinematics, cone),
                SingularityMargin(kinematics, self.singularity_margin),
            )
        )
