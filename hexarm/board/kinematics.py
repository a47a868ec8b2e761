"""The part of machine.h by which the board solves a crank hexapod's inverse kinematics itself."""

from collections.abc import Iterable

import numpy as np

from bridge.calibration import Calibration
from hexapod_control.geometry import LEGS
from hexapod_control.rotary import RotaryHexapod
from manipulator.limits.machine_limits import BodyHeight, JointRange
from manipulator.machine import Machine

WITHOUT: dict[str, object] = {'HAS_KINEMATICS': 0}


def kinematics_of(machine: Machine, calibration: Calibration) -> dict[str, object]:
    """The header's definitions, SI units and radians; HAS_KINEMATICS 0 for other machines."""
    kinematics = machine.kinematics
    if not isinstance(kinematics, RotaryHexapod):
        return WITHOUT
    g = kinematics.geometry
    legs = (
        [
            *map(braces, (g.crank_centres[i], g.normals[i], g.tangents[i], g.ups[i])),
            braces(g.platform_points[i]),
            number(g.crank_lengths[i]),
            number(g.rod_lengths[i]),
        ]
        for i in range(LEGS)
    )
    order = [calibration.names.index(name) for name in kinematics.joint_names]
    servos = ([str(calibration.channels[i]), *map(number, _scale(calibration, i))] for i in order)
    limits = machine.constraints.limits
    (cranks,) = (limit for limit in limits if isinstance(limit, JointRange))
    lowest = max(limit.minimum for limit in limits if isinstance(limit, BodyHeight))
    return {
        'HAS_KINEMATICS': 1,
        'LEG_GEOMETRY': _rows(legs),
        'SERVO_CALIBRATION': _rows(servos),
        'HOME_HEIGHT_M': number(g.home_height),
        'MINIMUM_HEIGHT_M': number(lowest),
        'CRANK_CENTRE_RAD': number(kinematics.crank_centre),
        'CRANK_LOWEST_RAD': number(cranks.low.max()),
        'CRANK_HIGHEST_RAD': number(cranks.high.min()),
    }


def number(value: float) -> str:
    """A C float, to the last bit."""
    return f'{np.float32(value):.9e}f'


def braces(values: Iterable[float]) -> str:
    """A C row of floats."""
    return f'{{{", ".join(map(number, values))}}}'


def _scale(calibration: Calibration, i: int) -> tuple[float, float, float]:
    return (
        float(calibration.centre[i]),
        float(calibration.centre_count[i]),
        float(calibration.scale[i]),
    )


def _rows(rows: Iterable[Iterable[str]]) -> str:
    return ' '.join(['{', *(f'{{{", ".join(row)}}},' for row in rows), '}'])
