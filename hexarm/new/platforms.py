"""What platforms on cranks, cylinders and rails share: joints, servo, scales.

Measures are those of hexarm/new/questions.py, in millimetres and degrees.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from hexapod_control.load import platform
from hexarm.new import lines
from hexarm.new.lines import line, num
from hexarm.new.servos import SERVOS, Servo
from manipulator.arrays import Array
from manipulator.machine import Machine, MachineFile
from manipulator.motion_limits import MotionConfig

Measures = Mapping[str, Any]
STAND_IN = MotionConfig(1.0, 1.0, 10.0, 1.0, 1.0, 10.0)
SINGULARITY_SHARE, MOST_SINGULARITY = 0.5, 0.3
"""Of σmin at home, what the limit is, and the most that it is."""
END_SHARE = 0.02
"""Of a stroke, what is kept free at either end."""


def around(angles: list[float]) -> Array:
    """Six angles in degrees; one is a leg's, of which the others are mirrored and turned."""
    if len(angles) > 1:
        return np.array(angles)
    thirds = np.repeat([0.0, 120.0, 240.0, 360.0], [1, 2, 2, 1])
    return thirds + angles[0] * np.array([1.0, -1.0] * 3)


def on_circle(radius: float, angles: list[float], height: float) -> Array:
    """Six points (6, 3)."""
    turn = np.radians(around(angles))
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(6, height)])


def joints_of(m: Measures) -> tuple[Array, Array]:
    """Those of base and platform, (6, 3) each, by circles or coordinates."""
    if m['given_by'] == 'coordinates':
        return np.array(m['base_joints_mm']), np.array(m['platform_joints_mm'])
    up = side_of(m)
    base = (m['base_radius_mm'], m['base_angles_deg'], up * m['base_joint_height_mm'])
    moving = (
        m['platform_radius_mm'],
        m['platform_angles_deg'],
        -up * m['platform_joint_height_mm'],
    )
    return on_circle(*base), on_circle(*moving)


def side_of(m: Measures) -> float:
    """1, or -1 for a platform that hangs below its base."""
    height = m['home_height_mm']
    return -1.0 if height != 'auto' and height < 0.0 else 1.0


def servo_of(m: Measures) -> Servo:
    """From the list, or of the numbers given."""
    if m['servo'] in SERVOS:
        return SERVOS[m['servo']]
    if m['servo'] == 'driver':
        return Servo(m['servo_speed_deg_s'], 1.0, 50.0, 360.0, None, 'as given')
    low, high = sorted(m['servo_pulse_us'])
    return Servo(
        m['servo_speed_deg_s'], m['servo_torque_n_m'], 50.0, m['servo_travel_deg'], (low, high),
        'as given',
    )  # fmt: skip


def machine_of(kind: str, geometry: dict[str, Any], limits: dict[str, Any]) -> Machine:
    """With these two sections alone."""
    return platform(MachineFile(kind, geometry, limits, STAND_IN, driver='topic'))


def _sigma(machine: Machine) -> float:
    """What the limit on σmin is."""
    kinematics = machine.kinematics
    sigma = kinematics.sigma_min(kinematics.home, kinematics.inverse(kinematics.home))
    return lines.significant(min(SINGULARITY_SHARE * float(sigma), MOST_SINGULARITY))


def radius_of(joints: Array) -> float:
    """Of the platform: what one radian counts."""
    away = np.linalg.norm(joints[:, :2] - joints[:, :2].mean(axis=0), axis=1)
    return max(float(np.round(np.sqrt(np.mean(away**2)))), 0.1)


def scales(machine: Machine, scale: float) -> Iterator[str]:
    """The limits on singularity, and what one radian counts."""
    yield line(f'  singularity_margin: {num(_sigma(machine))}', 'assumed: half of that at home')
    yield line(f'  characteristic_length_mm: {num(scale)}', "the platform's radius")


def platform_dynamics(m: Measures, scale: float) -> Iterator[str]:
    """The beginning of the section dynamics."""
    yield line('dynamics:', 'for hexarm mjcf and simulate: docs/physics.md; assumed')
    yield '  compensation: false'
    mass, load = num(m['platform_g']), num(m['payload_g'])
    yield f'  platform: {{mass_g: {mass}, thickness_mm: 4.0, source: estimate}}'
    size = num(lines.significant(scale / 2))
    yield f'  payload: {{mass_g: {load}, radius_mm: {size}, height_mm: {size}, source: estimate}}'
