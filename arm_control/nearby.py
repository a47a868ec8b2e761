"""The inverse for a pose beside a known one, by Newton's method: the tick's common case.

All branches of a closed form cost as much as ten of these; a stream of setpoints needs but one.
"""

import numpy as np

from arm_control.chain import Chain
from manipulator.arrays import Array
from manipulator.pose import Pose

BESIDE = 0.05
"""Metres and radians from the known pose, and radians of the joints, that count as beside it."""
CONVERGED = 1e-12
STEPS = 4


def nearby_joints(chain: Chain, pose: Pose, near: Array) -> Array:
    """The joints (6,) that continue `near` to one pose; NaN where that is not certain.

    It is certain within BESIDE, away from singular postures, where the method converges at once.
    """
    joints = near
    for _ in range(STEPS):
        error = chain.forward(joints).twist_to(pose)
        largest = np.abs(error).max()
        if largest < CONVERGED:
            return joints
        if largest > BESIDE:
            break
        try:
            joints = joints + np.linalg.solve(chain.jacobian(joints), error)
        except np.linalg.LinAlgError:
            break
        if np.abs(joints - near).max() > BESIDE:
            break
    return np.full(len(near), np.nan)
