"""A goal of joints: positions of some of them, by name."""

from collections.abc import Mapping

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import InvalidInput, NoSolution, Refused
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import JointRange
from manipulator.machine import Machine
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.joint_move import KNOTS, between, refuse_rule
from manipulator.planning.joint_points import check_names
from manipulator.trajectory.executor import Executor


def joint_goal(machine: Machine, executor: Executor, named: Mapping[str, float]) -> Goal:
    """The goal of a joint move; joints that are not named keep those of the motion under way.

    Raises InvalidInput for unknown joints and numbers that are not finite, Unreachable where a
    limit would be broken there, and Refused where the joints fix no pose, as those of a platform
    whose rods do not close.
    """
    kinematics = machine.kinematics
    refuse_rule(len(kinematics.joint_names))
    check_names(tuple(named), kinematics.joint_names)
    joints = executor.joints_to_come.copy()
    for name, position in named.items():
        if not np.isfinite(position):
            raise InvalidInput(f'{name} is {position}, needs a finite number')
        joints[kinematics.joint_names.index(name)] = position
    start = executor.state.pose
    _check_ranges(machine, executor.joints, joints)
    rows = between(executor.joints, joints, np.linspace(0.0, 1.0, KNOTS + 1))
    try:
        pose = kinematics.forward_along(rows, start)[-1]
    except NoSolution as error:
        raise Refused(f'these joints, together with the others, fix no pose: {error}') from error
    machine.constraints.stretched_to(start, executor.joints).check(pose, joints)
    return Goal(pose, motion=Motion.JOINT, joints=joints)


def _check_ranges(machine: Machine, now: Array, joints: Array) -> None:
    """Unreachable, with the joint and its range, beyond it; a joint outside may come back."""
    kinematics = machine.kinematics
    low, high = machine.joint_ranges
    quantity = 'joint angle' if kinematics.joint_unit == 'rad' else 'joint length'
    ranges = JointRange(
        np.minimum(low, now), np.maximum(high, now), kinematics.joint_names, quantity,
        kinematics.joint_unit,
    )  # fmt: skip
    Constraints((ranges,)).check(kinematics.home, joints)
