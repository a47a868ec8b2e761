"""A machine of any kind as a model to identify, and poses at which it may be measured."""

from typing import Protocol

import numpy as np

from arm_control.arm import SerialArm
from arm_control.identification.arm_model import JOINTS, ArmModel
from arm_control.identification.machine_values import geometry_lines as arm_lines
from hexapod_control.identification.leg_model import LegModel, Tolerances
from hexapod_control.identification.machine_values import geometry_lines
from hexapod_control.identification.model_of import model_of
from hexapod_control.workspace import sample
from manipulator.arrays import Array
from manipulator.identification.model import Model
from manipulator.kinematics import Kinematics
from manipulator.machine import Machine
from manipulator.pose import Pose

SHARE_OF_RANGE = 0.8
"""Of an arm's joint ranges: near their ends a joint may stand at its stop."""


class MachineModel(Model, Protocol):
    """A model whose joints have servos."""

    def joint_offsets(self, values: Array) -> Array:
        """(6,): true position less the commanded one, rad or m."""
        ...


def machine_model(kinematics: Kinematics, tolerances: Tolerances) -> MachineModel:
    """InvalidInput for a kind of machine that cannot be identified."""
    if isinstance(kinematics, SerialArm):
        return ArmModel(kinematics, tolerances.length, tolerances.angle)
    return model_of(kinematics, tolerances)


def new_geometry(model: MachineModel, values: Array) -> list[str]:
    """The lines of the machine file's `geometry`; none where all of it is in the servos."""
    if isinstance(model, ArmModel):
        is_as_told = not values[JOINTS:].any()
        return [] if is_as_told else arm_lines(model.identified(values), model.arm.rest)
    return geometry_lines(model.identified(values)) if isinstance(model, LegModel) else []


def random_poses(
    machine: Machine, count: int, generator: np.random.Generator
) -> tuple[Array, Pose]:
    """Joints (count, m) and poses over the whole workspace.

    Of an arm those above its base plane; where it would touch itself or a table nobody knows.
    """
    kinematics = machine.kinematics
    if not isinstance(kinematics, SerialArm):
        poses = sample(machine, count, generator, kinematics.characteristic_length)
        return kinematics.inverse(poses), poses
    low, high = kinematics.limits.low, kinematics.limits.high
    middle, half = (low + high) / 2, SHARE_OF_RANGE * (high - low) / 2
    joints = middle + half * generator.uniform(-1.0, 1.0, (4 * count, len(low)))
    poses = kinematics.chain.forward(joints)
    above = np.flatnonzero(poses.position[:, 2] > 0.0)[:count]
    return joints[above], poses[above]
