"""How fast a machine may move: its platform or tool, and each of its joints."""

import math
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from manipulator.arrays import Array, frozen
from manipulator.config import RATE, quantity
from manipulator.errors import ConfigError

BRAKING_SHARE = 0.3
"""The part of each acceleration limit that plans leave for braking along their path."""


SixNumbers: TypeAlias = tuple[float, float, float, float, float, float]


SPEED_NAMES = (
    *('linear speed', 'turning speed'),
    *(f'{kind} {axis} speed' for kind in ('linear', 'turning') for axis in 'xyz'),
)
"""Of all of the platform or tool, then along and about each axis."""


@dataclass(frozen=True)
class MotionConfig:
    """The `motion` section of a machine file; a joint limit is one for all joints, or six."""

    linear_speed_mm_s: float = quantity(*RATE, 'of the platform or the tool')
    linear_acceleration_mm_s2: float = quantity(*RATE, 'likewise')
    linear_jerk_mm_s3: float = quantity(*RATE, 'likewise')
    angular_speed_deg_s: float = quantity(*RATE, 'of the platform or the tool, about any axis')
    angular_acceleration_deg_s2: float = quantity(*RATE, 'likewise')
    angular_jerk_deg_s3: float = quantity(*RATE, 'likewise')
    joint_speed_deg_s: float | SixNumbers | None = quantity(
        *RATE, 'of every joint that turns, or of each', default=None
    )
    joint_acceleration_deg_s2: float | SixNumbers | None = quantity(
        *RATE, 'likewise', default=None
    )
    joint_speed_mm_s: float | SixNumbers | None = quantity(
        *RATE, 'of every leg that changes its length, or of each', default=None
    )
    joint_acceleration_mm_s2: float | SixNumbers | None = quantity(*RATE, 'likewise', default=None)


@dataclass(frozen=True)
class Derivatives:
    """Bounds on speed, acceleration and jerk, in SI units of one kind of motion."""

    speed: float
    acceleration: float
    jerk: float = math.inf


@dataclass(frozen=True, eq=False)
class JointDerivatives:
    """Bounds on each joint's speed and acceleration: (n,), or () where all joints are alike."""

    speed: Array
    acceleration: Array

    @classmethod
    def of(cls, speed: ArrayLike, acceleration: ArrayLike) -> 'JointDerivatives':
        """From numbers or arrays, in rad or m per s and s²."""
        return cls(frozen(speed), frozen(acceleration))

    def tightened(self, speed: Array, acceleration: Array) -> 'JointDerivatives':
        """The smaller bounds of both."""
        return JointDerivatives.of(
            np.minimum(self.speed, speed), np.minimum(self.acceleration, acceleration)
        )


@dataclass(frozen=True)
class MotionLimits:
    """Norm of linear velocity, norm of angular velocity, and every single joint.

    axis_speeds (6,) are along and about the axes of the frame in which poses are, m/s and rad/s.
    """

    linear: Derivatives
    angular: Derivatives
    joint: JointDerivatives
    axis_speeds: Array = field(default_factory=lambda: frozen(np.full(6, np.inf)), compare=False)

    @property
    def for_plans(self) -> 'MotionLimits':
        """The limits within which plans are made, so that each can be braked on its path."""

        def share(limit: Derivatives) -> Derivatives:
            return replace(limit, acceleration=(1.0 - BRAKING_SHARE) * limit.acceleration)

        joint = JointDerivatives.of(
            self.joint.speed, (1.0 - BRAKING_SHARE) * self.joint.acceleration
        )
        return replace(self, linear=share(self.linear), angular=share(self.angular), joint=joint)

    def speed_shares(self, twist: Array) -> Array:
        """The part of each limit in SPEED_NAMES that twists (..., 6) use: (..., 8)."""
        norms = np.sqrt((twist.reshape(*twist.shape[:-1], 2, 3) ** 2).sum(axis=-1))
        limits = np.array((self.linear.speed, self.angular.speed))
        return np.concatenate([norms / limits, np.abs(twist) / self.axis_speeds], axis=-1)

    @property
    def braking_rate(self) -> float:
        """How fast the rate of a plan at full speed may change (1/s), by the braking share."""
        ratios = [d.acceleration / d.speed for d in (self.linear, self.angular)]
        joints = np.broadcast_arrays(self.joint.acceleration, self.joint.speed)
        ratios += [
            a / v
            for a, v in zip(*(np.ravel(b).tolist() for b in joints), strict=True)
            if math.isfinite(a) and math.isfinite(v)
        ]
        return BRAKING_SHARE * min(ratios)

    @classmethod
    def from_config(cls, config: MotionConfig, joint_unit: str) -> 'MotionLimits':
        """SI units; joint_unit, 'rad' or 'm', is that of all joints of the machine.

        Raises ConfigError for limits of joints in the other unit.
        """
        degree, millimetre = math.radians(1), 1e-3
        is_linear = joint_unit == 'm'
        _check_unit(config, is_linear)
        if is_linear:
            joint = JointDerivatives.of(
                _scaled(config.joint_speed_mm_s, millimetre),
                _scaled(config.joint_acceleration_mm_s2, millimetre),
            )
        else:
            joint = JointDerivatives.of(
                _scaled(config.joint_speed_deg_s, degree),
                _scaled(config.joint_acceleration_deg_s2, degree),
            )
        return cls(
            Derivatives(
                config.linear_speed_mm_s * millimetre,
                config.linear_acceleration_mm_s2 * millimetre,
                config.linear_jerk_mm_s3 * millimetre,
            ),
            Derivatives(
                config.angular_speed_deg_s * degree,
                config.angular_acceleration_deg_s2 * degree,
                config.angular_jerk_deg_s3 * degree,
            ),
            joint,
        )


def _check_unit(config: MotionConfig, is_linear: bool) -> None:
    other, own = ('deg', 'mm') if is_linear else ('mm', 'deg')
    problems = [
        f'motion.{name.format(other)}: the joints are in {own}, needs {name.format(own)}'
        for name in ('joint_speed_{}_s', 'joint_acceleration_{}_s2')
        if getattr(config, name.format(other)) is not None
    ]
    if problems:
        raise ConfigError(problems)


def _scaled(limit: float | SixNumbers | None, unit: float) -> Array:
    """In SI units; ∞ where there is none."""
    scaled: Array = unit * np.asarray(math.inf if limit is None else limit, dtype=np.float64)
    return scaled
