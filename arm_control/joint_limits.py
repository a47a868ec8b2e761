"""What each joint of a serial arm may do: range, speed, acceleration."""

from dataclasses import dataclass

import numpy as np

from arm_control.geometry import JOINTS
from manipulator.arrays import Array, frozen
from manipulator.config import quantity
from manipulator.errors import ConfigError
from manipulator.limits.constraints import Constraints
from manipulator.limits.joint_range import JointRange

JOINT_NAMES = tuple(f'joint_{i}' for i in range(1, JOINTS + 1))
OWNERS = tuple(f'joint {i}' for i in range(1, JOINTS + 1))


@dataclass(frozen=True)
class JointConfig:
    """One joint in the units of its machine file."""

    range_deg: tuple[float, float] = quantity(-720, 720)
    speed_deg_s: float = quantity(0.1, 5000)
    acceleration_deg_s2: float = quantity(1, 1e6)

    def __post_init__(self) -> None:
        """Raises ConfigError for an empty range."""
        low, high = self.range_deg
        if not low < high:
            raise ConfigError([f'range_deg: [{low:g}, {high:g}] is empty'])


@dataclass(frozen=True)
class ArmLimits:
    """The `limits` section of a serial arm's machine file.

    damping_onset is the singular value below which a posture counts as near to singular, with
    metres divided by characteristic_length_mm (docs/arm-kinematics.md, 8).
    """

    joints: tuple[JointConfig, JointConfig, JointConfig, JointConfig, JointConfig, JointConfig]
    characteristic_length_mm: float = quantity(1, 5000)
    damping_onset: float = quantity(0.001, 0.5)

    def joint_limits(self) -> 'JointLimits':
        """In radians."""
        ranges = np.radians([joint.range_deg for joint in self.joints])
        return JointLimits(
            ranges[:, 0],
            ranges[:, 1],
            np.radians([joint.speed_deg_s for joint in self.joints]),
            np.radians([joint.acceleration_deg_s2 for joint in self.joints]),
        )


@dataclass(frozen=True, eq=False)
class JointLimits:
    """Arrays (6,) in rad, rad/s and rad/s²."""

    low: Array
    high: Array
    speed: Array
    acceleration: Array

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        for name in ('low', 'high', 'speed', 'acceleration'):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    def constraints(self) -> Constraints:
        """The joint ranges alone: a serial arm may stand in a singular posture."""
        return Constraints((JointRange(self.low, self.high, OWNERS),))
