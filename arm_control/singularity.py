"""Which singular posture an arm is near, in words (docs/arm-kinematics.md, 8)."""

import numpy as np

from arm_control.almost_closed import AlmostClosed
from arm_control.inverse_method import InverseMethod
from arm_control.parallel_axes import ParallelAxes
from arm_control.spherical_wrist import SphericalWrist
from manipulator.arrays import Array

TAKES_PART = 0.3
"""Of the fastest joint's rate, from which on another one takes part in an idle motion."""

SHOULDER = 'shoulder singularity (wrist on the axis of joint 1)'
ELBOW = 'elbow singularity (arm stretched or folded)'
WRIST = 'wrist singularity (axes of joints 4 and 6 in line)'
WRIST_PARALLEL = 'wrist singularity (axis of joint 6 parallel to that of joint 4)'


def singularity(method: InverseMethod, idle: Array) -> str:
    """The singularity by the joint motion (6,) that least moves the tool there.

    Arms without a spherical wrist or three parallel axes have no such names: the joints that
    cancel each other are listed.
    """
    ideal = method.ideal if isinstance(method, AlmostClosed) else method
    parts = np.abs(idle) >= TAKES_PART * np.abs(idle).max()
    if isinstance(ideal, SphericalWrist | ParallelAxes) and parts[0]:
        return SHOULDER
    if isinstance(ideal, SphericalWrist):
        return ELBOW if parts[1:3].any() else WRIST
    if isinstance(ideal, ParallelAxes):
        return WRIST_PARALLEL if parts[5] else ELBOW
    *most, last = (str(i) for i in np.flatnonzero(parts) + 1)
    return f'singular posture (joints {", ".join(most)} and {last} cancel each other)'
