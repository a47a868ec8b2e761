"""The inverse kinematics that the fake board plays cycles by: the firmware's, in Python."""

from collections.abc import Sequence

import numpy as np

from bridge.calibration import Calibration
from bridge.fake.board_courses import Counts, Solver
from hexapod_control.rotary import RotaryHexapod
from manipulator import rotation
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import BodyHeight, JointRange
from manipulator.machine import Machine
from manipulator.pose import Pose


def board_solver(machine: Machine, calibration: Calibration) -> Solver | None:
    """None for machines whose kinematics the board does not know.

    The board checks what the firmware checks: that the legs close, the crank range and the
    body's height. The host checks the rest before it asks for a cycle.
    """
    kinematics = machine.kinematics
    if not isinstance(kinematics, RotaryHexapod):
        return None
    known = (limit for limit in machine.constraints.limits if isinstance(limit, _ON_THE_BOARD))
    constraints = Constraints(tuple(known))
    order = [calibration.names.index(name) for name in kinematics.joint_names]

    def solve(offsets: Sequence[float]) -> Counts | None:
        position = kinematics.home.position + np.array(offsets[:3])
        pose = Pose(position, rotation.from_rpy(np.array(offsets[3:])))
        cranks = kinematics.inverse_or_nan(pose)
        if not np.isfinite(cranks).all() or not bool(constraints.admits(pose, cranks)):
            return None
        counts = [0.0] * len(calibration.names)
        for crank, i in zip(cranks.tolist(), order, strict=True):
            exact = calibration.centre_count[i] + calibration.scale[i] * (
                crank - calibration.centre[i]
            )
            counts[calibration.channels[i]] = float(exact)
        return tuple(counts)

    return solve


_ON_THE_BOARD = (JointRange, BodyHeight)
