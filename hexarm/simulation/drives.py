"""Servos as a model sees them: a motor behind a proportional controller.

The motor's effort is effort·(u − rate/speed), its voltage u = error/band kept within ±1: all of
it at standstill, none at free speed. Kept apart, the two terms are a spring that saturates and a
damper, which is how MuJoCo gets them.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hexarm.simulation.dynamics_config import PushingDriveConfig, TurningDriveConfig
from manipulator.arrays import Array, frozen
from manipulator.errors import ConfigError


@dataclass(frozen=True, eq=False)
class Drives:
    """One value a joint (n,): N·m or N, rad/s or m/s, rad or m, kg·m² or kg.

    effort at standstill, free speed, the error (band) at which the whole effort is given, what
    the gears hold without power, and the rotor's inertia at the output.
    """

    effort: Array
    speed: Array
    band: Array
    backdrive: Array
    rotor: Array

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        for name in ('effort', 'speed', 'band', 'backdrive', 'rotor'):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def stiffness(self) -> Array:
        """Effort by error within the band."""
        return self.effort / self.band

    @property
    def damping(self) -> Array:
        """Effort lost by speed: the motor's back voltage."""
        return self.effort / self.speed

    def stronger(self, effort: ArrayLike) -> 'Drives':
        """The same with another effort at standstill."""
        return replace(self, effort=np.broadcast_to(effort, self.effort.shape))


def turning(configs: tuple[TurningDriveConfig, ...], speeds: Array) -> Drives:
    """Drives that turn, and their free speeds (n,), rad/s."""
    return Drives(
        np.array([c.torque_n_m for c in configs]),
        speeds,
        np.radians([c.proportional_band_deg for c in configs]),
        np.array([c.backdrive_n_m for c in configs]),
        np.array([1e-9 * c.rotor_inertia_g_mm2 for c in configs]),
    )


def servo_speeds(servos: dict[str, Any], count: int) -> Array:
    """Of `count` equal servos that turn, by the section `servos`: (n,) in rad/s."""
    return np.full(count, math.radians(_speed(servos, 'speed_deg_s')))


def pusher_speeds(servos: dict[str, Any], count: int) -> Array:
    """Of `count` equal servos that push, likewise: (n,) in m/s."""
    return np.full(count, 1e-3 * _speed(servos, 'speed_mm_s'))


def pushing(config: PushingDriveConfig, speeds: Array) -> Drives:
    """Equal drives that push, and their free speeds (n,), m/s."""
    values = (
        config.force_n,
        speeds,
        1e-3 * config.proportional_band_mm,
        config.backdrive_n,
        1e-3 * config.rotor_mass_g,
    )
    return Drives(*(np.broadcast_to(value, speeds.shape) for value in values))


def _speed(servos: dict[str, Any], key: str) -> float:
    speed = servos.get(key)
    if isinstance(speed, bool) or not isinstance(speed, int | float) or not speed > 0:
        raise ConfigError([f'servos.{key}: {speed!r}, the model needs a speed above 0'])
    return float(speed)
