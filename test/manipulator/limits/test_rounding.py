"""A machine that stands exactly at a limit may stay there: its pose, solved again, is rounded."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.limits.constraints import Constraints
from manipulator.limits.machine_limits import JointRange
from manipulator.pose import Pose


@pytest.mark.parametrize(('beyond', 'is_kept'), [(0.0, True), (1e-12, True), (1e-7, False)])
def test_joints_at_the_end_of_their_range_are_kept_but_for_rounding(beyond, is_kept):
    limits = Constraints((JointRange(np.zeros(2), np.ones(2), ('a', 'b')),))
    for joints in (np.array([0.5, 1.0 + beyond]), np.array([-beyond, 0.5])):
        assert limits.admits(Pose.identity(), joints) == is_kept


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r'])
def test_a_pose_that_is_found_from_joints_at_a_limit_keeps_it(name):
    machine = load(name)
    kinematics, home = machine.kinematics, machine.kinematics.home
    low, _ = machine.joint_ranges
    generator = np.random.default_rng(1)
    for k in range(60):
        joints = kinematics.inverse(home) + generator.uniform(-0.002, 0.002, 6)
        ends = Constraints((JointRange(np.maximum(low, -9.0), joints, ('joint',) * 6),))
        pose = kinematics.forward(joints, home).pose
        assert ends.admits(pose, kinematics.inverse(pose, joints)), k
