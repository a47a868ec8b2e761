"""Poses that a serial arm can take."""

import numpy as np

from arm_control.arm import SerialArm
from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.pose import Pose


def sample(machine: Machine, count: int, rng: np.random.Generator) -> Pose:
    """`count` poses of joint angles that are uniform within the joint ranges, or a whole turn.

    Raises InvalidInput for a machine that is no serial arm.
    """
    arm = machine.kinematics
    if not isinstance(arm, SerialArm):
        raise InvalidInput(f'{type(arm).__name__} is no serial arm')
    return arm.chain.forward(rng.uniform(*arm.limits.sampled, (count, 6)))
