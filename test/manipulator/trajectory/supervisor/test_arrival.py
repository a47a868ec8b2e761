"""A goal is reached when the joints are there, by unit and range; else it says what is off."""

import re
from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.planning.goal import Goal
from manipulator.pose import Pose
from manipulator.trajectory.following_error import ARRIVAL_PATIENCE, Tolerances
from manipulator.trajectory.supervisor import MotionSupervisor

DT = 0.01


class Machine:
    """A supervisor and joints that are measured, each off its command by `play` (n,)."""

    def __init__(self, machine, play, tolerances=None):
        self.machine = load(machine) if isinstance(machine, str) else machine
        self.kinematics = self.machine.kinematics
        self.supervisor = MotionSupervisor(self.machine, DT, tolerances)
        self.play = np.asarray(play)
        self.supervisor.note_machine_state('enabled', is_followed=False, is_measured=True)
        joints = self.kinematics.inverse(self.kinematics.home)
        self.see(joints)
        self.supervisor.step()
        self.supervisor.note_machine_state('enabled', is_followed=True, is_measured=True)

    def see(self, joints):
        pose = self.kinematics.forward(joints, self.kinematics.home).pose
        self.supervisor.note_joints(joints)
        self.supervisor.note_pose(pose)

    def go(self, goal, ticks=600):
        """The results that were reported, in turn, and the last status."""
        self.supervisor.executor.pursue(Goal(goal, 1.0))
        results = []
        for _ in range(ticks):
            pose = self.supervisor.step()
            if pose is None:
                break
            self.see(self.supervisor.executor.joints + self.play)
            if self.supervisor.status.result not in results[-1:]:
                results.append(self.supervisor.status.result)
        return results, self.supervisor.status


def test_an_arm_with_two_degrees_of_play_is_stopped_with_joint_and_distance():
    arm = Machine('arm_6r_stepper', np.radians([0, 2.0, 0, 0, 0, 0]))
    results, status = arm.go(arm.kinematics.home.moved([0.1, 0, 0.05, 0, 0, 0]))
    assert results == ['moving', 'stopped']
    assert status.goal_stamp == 1.0
    assert 'joint_2 is 2° away from the goal (tolerance 0.5°)' in status.reason
    assert 'missed by' in status.reason
    assert 'mm' in status.reason
    assert arm.supervisor.is_driving  # it holds, and takes the next goal
    arm.play[:] = 0.0
    results, status = arm.go(arm.kinematics.home)
    assert status.result == 'reached'


def test_an_arm_within_the_tolerance_reaches_its_goal():
    arm = Machine('arm_6r_stepper', np.radians([0, 0.02, 0, 0, 0, 0]))
    results, _ = arm.go(arm.kinematics.home.moved([0.1, 0, 0.05, 0, 0, 0]))
    assert results == ['moving', 'reached']


def test_an_arm_whose_joints_are_near_but_whose_tool_is_not_is_stopped_with_the_distance():
    arm = Machine('arm_6r_stepper', np.radians([0, 0.3, 0, 0, 0, 0]))
    results, status = arm.go(arm.kinematics.home.moved([0.1, 0, 0.05, 0, 0, 0]))
    assert results == ['moving', 'stopped']
    assert re.match(r'the goal is missed by [\d.]+ mm and 0.3° \(tolerance 0.4 mm', status.reason)


def test_joints_within_two_counts_are_there_unless_a_distance_is_asked_for():
    machine = replace(load('arm_6r_stepper'), resolution=np.full(6, np.radians(0.2)))
    off = np.radians([0, 0.3, 0, 0, 0, 0])
    for distance, result in ((0.0, 'reached'), (1e-3, 'stopped')):
        arm = Machine(machine, off, Tolerances.of(machine, distance=distance))
        goal = arm.kinematics.home.moved([0.1, 0, 0.05, 0, 0, 0])
        assert arm.go(goal)[1].result == result


def test_the_tolerance_can_be_asked_for():
    machine = load('arm_6r_stepper')
    wide = Tolerances.of(machine, goal=np.radians(3.0), distance=0.05)
    arm = Machine('arm_6r_stepper', np.radians([0, 2.0, 0, 0, 0, 0]), wide)
    assert arm.go(arm.kinematics.home.moved([0.1, 0, 0, 0, 0, 0]))[1].result == 'reached'


def test_a_stuck_leg_of_a_linear_platform_ends_the_motion_and_is_named():
    platform = Machine('stewart_6_6', np.zeros(6))
    stuck = platform.kinematics.inverse(platform.kinematics.home)[2]

    def see_stuck(joints):
        joints = joints.copy()
        joints[2] = stuck
        platform.supervisor.note_joints(joints)
        platform.supervisor.note_pose(platform.kinematics.home)

    platform.see = see_stuck
    goal = Pose.from_xyz_rpy((0.0, 0.0, platform.kinematics.home.position[2] + 0.02))
    results, status = platform.go(goal)
    assert status.result == 'stopped'
    assert 'reached' not in results
    assert status.reason.startswith('leg_3 is ')
    assert 'mm away from' in status.reason


def test_joints_that_come_within_the_patience_reach_the_goal():
    arm = Machine('arm_6r_stepper', np.radians([0, 2.0, 0, 0, 0, 0]))
    arm.supervisor.executor.pursue(Goal(arm.kinematics.home.moved([0.05, 0, 0, 0, 0, 0]), 1.0))
    while arm.supervisor.executor.status.result != 'reached':
        arm.supervisor.step()
        arm.see(arm.supervisor.executor.joints + arm.play)
    for _ in range(round(0.5 * ARRIVAL_PATIENCE / DT)):
        arm.supervisor.step()
        arm.see(arm.supervisor.executor.joints + arm.play)
    assert arm.supervisor.status.result == 'moving'
    arm.see(arm.supervisor.executor.joints)
    arm.supervisor.step()
    assert arm.supervisor.status.result == 'reached'


def test_a_pivot_that_is_set_meanwhile_waits_for_what_becomes_of_the_goal():
    arm = Machine('arm_6r_stepper', np.radians([0, 2.0, 0, 0, 0, 0]))
    arm.supervisor.set_pivot((0.0, 0.0, 0.1))
    results, status = arm.go(arm.kinematics.home.moved([0.05, 0, 0, 0, 0, 0]))
    assert results == ['moving', 'stopped']
    assert status.goal_stamp == 1.0
    arm.play[:] = 0.0
    arm.supervisor.set_pivot((0.0, 0.0, 0.2))
    results, status = arm.go(arm.supervisor.machine.kinematics.home)
    assert results == ['moving', 'reached']
    assert arm.supervisor.machine.frames.T_platform_pivot.position[2] == pytest.approx(0.2)


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'arm_6r', 'ur5'])
def test_default_tolerances_follow_from_unit_and_range(name):
    machine = load(name)
    low, high = machine.joint_ranges
    tolerances = Tolerances.of(machine)
    assert (tolerances.following <= 0.0601 * (high - low)).all()
    assert (tolerances.goal < tolerances.following).all()
    if machine.kinematics.joint_unit == 'rad':
        assert (tolerances.goal <= np.radians(0.5) + 1e-12).all()
        assert (tolerances.following <= 0.2).all()
    else:
        assert tolerances.following.max() < 0.01  # a stroke of 96 mm, not 0.2 m
