"""The `limits` section of a crank hexapod's machine file."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.passive_joints import LEG_NAMES, CrankJointTilt, PlatformJointSwing
from hexapod_control.rotary import RotaryHexapod
from manipulator.config import quantity
from manipulator.errors import ConfigError
from manipulator.limits.body_height import BodyHeight
from manipulator.limits.constraints import Constraints
from manipulator.limits.joint_range import JointRange
from manipulator.limits.rod_closure import RodClosure
from manipulator.limits.singularity_margin import SingularityMargin


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
