"""Poses from joints that come one after the other."""

from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import ManipulatorError, NoSolution
from manipulator.pose_estimate import AFRESH, PoseEstimate

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
JOINTS = MACHINE.kinematics.inverse(HOME)
TURNED = HOME.moved(np.array([0.002, 0.002, 0.002, 0.03, -0.03, 0.05]))


class Failing:
    """A machine's kinematics whose warm solutions are not found."""

    def __init__(self):
        self.starts = []

    def __getattr__(self, name):
        return getattr(MACHINE.kinematics, name)

    def forward(self, joints, near=None):
        self.starts.append(near)
        if near is not None:
            raise NoSolution('it does not converge')
        return MACHINE.kinematics.forward(joints)


def assert_same(pose, expected):
    assert np.abs(pose.twist_to(expected)).max() < 1e-6


def test_the_pose_makes_the_joints():
    estimate = PoseEstimate(MACHINE)
    for pose in (HOME, TURNED):
        assert_same(estimate.update(MACHINE.kinematics.inverse(pose)).pose, pose)


def test_joints_that_are_not_all_known_end_the_estimate():
    estimate = PoseEstimate(MACHINE)
    estimate.update(JOINTS)
    assert estimate.update(None) is None
    assert estimate.solution is None


def test_where_the_last_pose_leads_nowhere_it_begins_at_home_and_reports_that():
    kinematics, notes = Failing(), []
    estimate = PoseEstimate(replace(MACHINE, kinematics=kinematics), notes.append)
    estimate.update(JOINTS)
    assert_same(estimate.update(JOINTS).pose, HOME)
    assert [near is None for near in kinematics.starts] == [True, False, True]
    assert notes == [AFRESH]


def test_a_pose_beyond_a_limit_is_followed_but_not_begun_with():
    depths = (HOME.moved(np.array([0, 0, z, 0, 0, 0])) for z in np.linspace(0.0, -0.04, 41))
    beyond = next(pose for pose in depths if not is_allowed(pose))
    joints = MACHINE.kinematics.inverse(beyond)
    with pytest.raises(ManipulatorError):
        PoseEstimate(MACHINE).update(joints)
    estimate = PoseEstimate(MACHINE)
    estimate.update(JOINTS)
    assert_same(estimate.update(joints).pose, beyond)


def is_allowed(pose):
    return bool(MACHINE.constraints.admits(pose, MACHINE.kinematics.inverse(pose)))


def test_what_the_drives_stay_behind_by_is_taken_out():
    deflection = 0.01 * np.ones(6)
    machine = replace(MACHINE, deflection=lambda pose, joints: deflection)
    solution = PoseEstimate(machine).update(JOINTS + deflection)
    assert_same(solution.pose, HOME)


def test_an_arm_beyond_its_range_is_where_its_joints_put_it():
    arm = load('arm_6r')
    joints = arm.joint_ranges[1] + 0.1
    solution = PoseEstimate(arm).update(joints)
    assert_same(solution.pose, arm.kinematics.forward(joints).pose)
