"""The `limits` section of a linear platform's machine file."""

from dataclasses import dataclass

import numpy as np

from hexapod_control.linear import LinearPlatform
from hexapod_control.passive_joints import LEG_NAMES, BaseJointSwing, PlatformJointSwing
from manipulator.config import quantity
from manipulator.errors import ConfigError
from manipulator.limits.constraints import Constraints
from manipulator.limits.joint_range import JointRange
from manipulator.limits.singularity_margin import SingularityMargin


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
