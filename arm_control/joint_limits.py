"""The joints of a serial arm in its machine file: names, ranges, speeds, accelerations."""

import re
from dataclasses import dataclass

import numpy as np

from arm_control.chain import JOINTS
from arm_control.geometry import MOST_DEG
from manipulator.arrays import Array, frozen
from manipulator.config import RATE, SIZE_MM, key, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import shown
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import JointRange

JOINT_NAMES = tuple(f'joint_{i}' for i in range(1, JOINTS + 1))
"""Of joints that have no name of their own."""
NAME = re.compile(r'[\w./-]{1,64}')


@dataclass(frozen=True)
class JointConfig:
    """One joint in the units of its machine file.

    A continuous joint turns without end, and has no range. name: as in `joint_states`, with any
    prefix; without it joint_1 to joint_6.
    """

    speed_deg_s: float = quantity(*RATE, 'largest')
    acceleration_deg_s2: float = quantity(*RATE, 'largest')
    range_deg: tuple[float, float] | None = quantity(-MOST_DEG, MOST_DEG, 'travel', default=None)
    continuous: bool = key('turns without end, and has no range', default=False)
    name: str | None = key(
        'in `joint_states` and messages, with any prefix; default `joint_1` …', default=None
    )

    def __post_init__(self) -> None:
        """Raises ConfigError unless there is a range, or none, and for a name that is none."""
        problems = []
        if self.continuous and self.range_deg is not None:
            problems.append('range_deg: a continuous joint has none')
        elif not self.continuous and self.range_deg is None:
            problems.append('range_deg: missing (a joint without end needs continuous: true)')
        elif self.range_deg is not None and not self.range_deg[0] < self.range_deg[1]:
            low, high = self.range_deg
            problems.append(f'range_deg: [{low:g}, {high:g}] is empty')
        if self.name is not None and NAME.fullmatch(self.name) is None:
            needs = 'needs 1 to 64 letters, digits, _ . / or -'
            problems.append(f'name: {shown(self.name)} {needs}')
        if problems:
            raise ConfigError(problems)

    @property
    def ends_deg(self) -> tuple[float, float]:
        """The range; infinite where it turns without end."""
        return (-np.inf, np.inf) if self.range_deg is None else self.range_deg


@dataclass(frozen=True)
class ArmLimits:
    """The `limits` section of a serial arm's machine file.

    damping_onset is the singular value below which a posture counts as near to singular, with
    metres divided by characteristic_length_mm (docs/arm-kinematics.md, 8).
    """

    joints: tuple[JointConfig, JointConfig, JointConfig, JointConfig, JointConfig, JointConfig] = (
        key('base first')
    )
    characteristic_length_mm: float = quantity(
        *SIZE_MM, 'what one radian counts: about half the reach'
    )
    damping_onset: float = quantity(
        0.001, 0.5, 'singular value from which a posture is near to singular'
    )

    def __post_init__(self) -> None:
        """Raises ConfigError for two joints of one name."""
        if len(set(self.names)) < JOINTS:
            raise ConfigError([f'joints: duplicate names in {", ".join(self.names)}'])

    @property
    def names(self) -> tuple[str, ...]:
        """Of the joints, base first."""
        named = zip(self.joints, JOINT_NAMES, strict=True)
        return tuple(joint.name or default for joint, default in named)

    def joint_limits(self) -> 'JointLimits':
        """In radians."""
        ranges = np.radians([joint.ends_deg for joint in self.joints])
        return JointLimits(
            ranges[:, 0],
            ranges[:, 1],
            np.radians([joint.speed_deg_s for joint in self.joints]),
            np.radians([joint.acceleration_deg_s2 for joint in self.joints]),
            self.names,
        )


@dataclass(frozen=True, eq=False)
class JointLimits:
    """Arrays (6,) in rad, rad/s and rad/s²; ±∞ where a joint turns without end. Names by joint."""

    low: Array
    high: Array
    speed: Array
    acceleration: Array
    names: tuple[str, ...] = JOINT_NAMES

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        for name in ('low', 'high', 'speed', 'acceleration'):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def owners(self) -> tuple[str, ...]:
        """What messages call the joints: 'joint 3', or its own name."""
        pairs = zip(self.names, JOINT_NAMES, strict=True)
        return tuple(n.replace('_', ' ') if n == default else n for n, default in pairs)

    @property
    def sampled(self) -> tuple[Array, Array]:
        """Low and high (6,) between which every posture is: one turn of a continuous joint."""
        has_end = np.isfinite(self.high)
        return np.where(has_end, self.low, -np.pi), np.where(has_end, self.high, np.pi)

    def constraints(self) -> Constraints:
        """The joint ranges alone: a serial arm may stand in a singular posture."""
        return Constraints((JointRange(self.low, self.high, self.owners),))
