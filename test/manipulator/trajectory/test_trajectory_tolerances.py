"""Tolerances of FollowJointTrajectory goals: by name; zero is the machine's own, negative none."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import InvalidInput
from manipulator.planning.joint_points import InvalidJoints
from manipulator.trajectory.trajectory_tolerances import JointTolerance, TrajectoryTolerances

MACHINE = load('arm_6r')
DESIRED = np.zeros(6)


def tolerances(path=(), goal=(), time=0.0):
    given = ([JointTolerance(*one) for one in some] for some in (path, goal))
    return TrajectoryTolerances.of(MACHINE, *given, time)


def test_only_the_named_joints_are_judged_and_only_by_positive_tolerances():
    given = tolerances(path=[('joint_2', 0.1), ('joint_3', -1.0), ('joint_4', 0.0)])
    far = np.array([9.0, 0.1, 9.0, 9.0, 9.0, 9.0])
    assert given.path_violation(DESIRED, far) == ''
    assert given.goal_violation(DESIRED, far, far) == ''
    far[1] = -0.2
    assert given.path_violation(DESIRED, far) == (
        'joint_2 is 0.2 rad from the trajectory, its tolerance is 0.1 rad'
    )


def test_the_time_to_keep_goal_tolerances_is_a_second_unless_one_is_given():
    assert tolerances().goal_time == 1.0
    assert tolerances(time=3.0).goal_time == 3.0


def test_unknown_joints_and_numbers_that_are_not_finite_are_named():
    with pytest.raises(InvalidJoints, match="goal_tolerance: joint 'elbow' is unknown"):
        tolerances(goal=[('elbow', 0.1)])
    with pytest.raises(InvalidInput, match=r'path_tolerance of joint_1 is \[nan'):
        tolerances(path=[('joint_1', float('nan'))])


def test_a_joint_that_still_moves_at_the_end_breaks_a_velocity_tolerance():
    given = tolerances(goal=[('joint_2', 0.1, 0.01)])
    speed = np.array([9.0, 0.02, 9.0, 9.0, 9.0, 9.0])
    assert given.goal_violation(DESIRED, DESIRED, speed) == (
        'joint_2 still moves at 0.02 rad/s, its tolerance is 0.01 rad/s'
    )
    assert given.goal_violation(DESIRED, DESIRED, speed / 4) == ''
    assert given.goal_violation(DESIRED, DESIRED, np.full(6, np.nan)) != ''


def test_tolerances_of_what_is_not_measured_are_refused_by_name():
    with pytest.raises(InvalidInput, match='velocity in path_tolerance of joint_1 is'):
        tolerances(path=[('joint_1', 0.1, 0.1)])
    with pytest.raises(InvalidInput, match='acceleration in goal_tolerance of joint_1 is 2'):
        tolerances(goal=[('joint_1', 0.0, 0.0, 2.0)])
    tolerances(path=[('joint_1', 0.1, 0.0, -1.0)])
