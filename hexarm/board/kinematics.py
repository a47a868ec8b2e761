"""The geometry by which the board solves a crank hexapod's inverse kinematics itself."""

import numpy as np

from bridge.calibration import Calibration
from bridge.fake.program import CrankHexapod, CrankLegs, CrankServo
from hexapod_control.rotary import RotaryHexapod
from manipulator.limits.machine_limits import BodyHeight, JointRange
from manipulator.machine import Machine


def crank_hexapod(machine: Machine, calibration: Calibration) -> CrankHexapod | None:
    """In SI units and radians; None for machines whose kinematics the board does not know.

    The board checks that the legs close, the crank range and the body's height. The host checks
    the rest before it asks for a cycle.
    """
    kinematics = machine.kinematics
    if not isinstance(kinematics, RotaryHexapod):
        return None
    limits = machine.constraints.limits
    (cranks,) = (limit for limit in limits if isinstance(limit, JointRange))
    lowest = max(limit.minimum for limit in limits if isinstance(limit, BodyHeight))
    order = [calibration.names.index(name) for name in kinematics.joint_names]
    return CrankHexapod(
        is_known=True,
        home_position=tuple(kinematics.home.position.tolist()),
        home_rotation=tuple(kinematics.home.rotation.ravel().tolist()),
        minimum_height=lowest,
        crank_lowest=tuple(cranks.low.tolist()),
        crank_highest=tuple(cranks.high.tolist()),
        legs=_legs(kinematics),
        servos=tuple(_servo(calibration, i) for i in order),
    )


def _legs(kinematics: RotaryHexapod) -> CrankLegs:
    g = kinematics.geometry
    vectors = (g.crank_centres, g.normals, g.tangents, g.ups, g.platform_points)
    by_coordinate = (tuple(map(tuple, np.asarray(v).T.tolist())) for v in vectors)
    numbers = (g.crank_lengths, g.rod_lengths, kinematics.crank_middles)
    return CrankLegs(*by_coordinate, *(tuple(v.tolist()) for v in numbers))


def _servo(calibration: Calibration, i: int) -> CrankServo:
    return CrankServo(
        calibration.channels[i],
        float(calibration.centre[i]),
        float(calibration.centre_count[i]),
        float(calibration.scale[i]),
    )
