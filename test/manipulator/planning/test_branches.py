"""Lines stay on the branch that an arm is on, or are refused with the joint and its stop."""

import os
import re

import numpy as np
import pytest

from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.errors import ManipulatorError
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.plan import MotionState
from manipulator.planning.planner import plan_goal
from manipulator.planning.start import Start
from manipulator.planning.worker import MOST_POSES, Effort
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Feedback
from manipulator.teleop.modes import jog_mode
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.jogging import JogCommand

DT = 0.01
FREE = jog_mode('free', Feedback.for_delay(0.0))
ARMS = ['arm_6r', 'ur5', 'puma560']
GOALS = int(os.environ.get('GOALS', '30'))
MACHINES = [*ARMS, 'robocake', 'stewart_6_3', 'stewart_6_6']


def executor_at(machine, degrees=None):
    k = machine.kinematics
    joints = k.inverse(k.home) if degrees is None else np.radians(degrees)
    return Executor(machine, k.forward(joints).pose, joints, DT)


def driven(executor, goal, ticks=2000):
    """The status that a goal ends with, and the largest step of a joint on the way."""
    executor.pursue(goal)
    joints = [executor.joints]
    for _ in range(ticks):
        executor.step()
        joints.append(executor.joints)
        if executor.status.result in ('reached', 'refused', 'stopped'):
            break
    return executor.status, np.abs(np.diff(joints, axis=0)).max()


def home_of(machine):
    k = machine.kinematics
    return Goal(k.home, 9.0, motion=Motion.ANY, joints=k.inverse(k.home))


def quarter_turn(pose):
    return Pose(pose.position, pose.rotation @ so3.exp(np.array([0.0, 0.0, np.pi / 2])))


def test_the_fourth_quarter_turn_meets_the_stop_of_joint_6_and_home_unwinds_it():
    machine = load('arm_6r')
    executor = executor_at(machine)
    for k in range(3):
        status, _ = driven(executor, Goal(quarter_turn(executor.state.pose), 1.0 + k))
        assert status.result == 'reached'
    there = executor.state.pose
    status, _ = driven(executor, Goal(quarter_turn(there), 4.0))
    assert (status.result, status.goal_stamp) == ('refused', 4.0)
    assert 'joint 6' in status.reason
    assert '6.109' in status.reason  # its stop, 350°
    assert 'of the line' in status.reason
    assert 'goal_motion: joint' in status.reason  # what would work
    assert np.abs(executor.state.pose.twist_to(there)).max() == 0.0
    status, step = driven(executor, home_of(machine))
    assert status.result == 'reached'
    assert step <= 1.01 * machine.motion.joint.speed.max() * DT
    np.testing.assert_allclose(executor.joints, machine.kinematics.rest, atol=1e-9)


@pytest.mark.parametrize(
    ('name', 'xyz', 'xyzw', 'joint'),
    [
        ('arm_6r', (-0.1, 0.33073, 0.58642), (-0.70711, 0.0, -0.70711, 0.0), 'joint 5'),
        ('puma560', (0.6963, -0.25005, 0.65748), (0.0, 0.92388, 0.0, 0.38268), 'joint 4'),
    ],
)
def test_a_line_that_a_stop_cuts_is_refused_by_name_and_a_joint_move_gets_there(
    name, xyz, xyzw, joint
):
    machine = load(name)
    goal = Pose.from_xyz_quaternion(xyz, np.array(xyzw) / np.linalg.norm(xyzw))
    executor = executor_at(machine)
    status, _ = driven(executor, Goal(goal, 1.0))
    assert status.result == 'refused'
    assert joint in status.reason
    assert 'outside' in status.reason
    status, step = driven(executor, Goal(goal, 2.0, motion=Motion.JOINT))
    assert status.result == 'reached'
    assert np.abs(executor.state.pose.twist_to(goal)).max() < 1e-9
    assert step <= 1.01 * machine.motion.joint.speed.max() * DT


@pytest.mark.parametrize('direction', range(12))
def test_home_is_reached_from_wherever_a_stick_has_led(direction):
    machine = load('arm_6r')
    executor = executor_at(machine)
    twist = np.zeros(6)
    axis, sign = direction % 6, 1 - 2 * (direction // 6)
    twist[axis] = sign * (0.2 if axis < 3 else 1.2)
    executor.jog(JogCommand('cmd_vel/joy', twist, '', FREE))
    for tick in range(600):
        before, pose = executor.state.pose, executor.step()
        if tick > 20 and not before.twist_to(pose).any():
            break  # at the edge
    executor.jog(None)
    for _ in range(50):
        executor.step()
    status, step = driven(executor, home_of(machine))
    assert status.result == 'reached', status.reason
    assert step <= 1.01 * machine.motion.joint.speed.max() * DT
    np.testing.assert_allclose(executor.joints, machine.kinematics.rest, atol=1e-9)


def test_home_unwinds_a_joint_that_stands_at_270_degrees():
    machine = load('arm_6r')
    status, _ = driven(executor_at(machine, [0, 20, 80, 0, 80, 270]), home_of(machine))
    assert status.result == 'reached'


def test_a_line_through_a_singular_posture_is_refused_with_the_joints_that_would_jump():
    """The wrist would pass straight through its aligned posture, where joints 4 and 6 flip."""
    machine = load('arm_6r')
    k = machine.kinematics
    begin = k.forward(np.radians([0, 20, 80, 30, 20, 0])).pose
    through = k.forward(np.radians([0, 20, 80, 30, 0, 0])).pose
    way = begin.twist_to(through)
    across = begin.moved(2 * way + [0, 0, 0, 0.0, 1e-4, 0])
    start = Start(MotionState.at_rest(begin), np.radians([0, 20, 80, 30, 20, 0]), DT)
    effort = Effort()
    try:
        plan = plan_goal(machine, start, Goal(across), effort)
    except ManipulatorError as error:
        assert re.search(r'joint.4', str(error))
    else:
        times = np.arange(0.0, plan.duration, DT)
        joints = k.inverse_along(plan.at(times).pose, start.joints)
        assert (
            np.abs(np.diff(joints, axis=0)).max() <= 1.01 * machine.motion.joint.speed.max() * DT
        )
    assert effort.poses < MOST_POSES


def random_posture(machine, rng):
    """Joints within the ranges, by the pose for platforms, and the pose."""
    k = machine.kinematics
    if k.joint_unit == 'rad' and hasattr(k, 'inverse_all') and hasattr(k, 'chain'):
        low, high = machine.joint_ranges
        joints = rng.uniform(np.maximum(low, -np.pi), np.minimum(high, np.pi))
        return joints, k.forward(joints).pose
    while True:
        size = 0.15 * k.characteristic_length
        pose = k.home.moved(np.concatenate([rng.normal(size=3) * size, rng.normal(size=3) * 0.1]))
        joints = k.inverse_or_nan(pose)
        if np.isfinite(joints).all() and machine.constraints.admits(pose, joints):
            return joints, pose


@pytest.mark.parametrize('name', MACHINES)
def test_no_goal_costs_more_than_it_may_and_every_plan_keeps_the_limits(name):
    """Random postures and goals, near and far; GOALS=20000 in the environment tries more."""
    machine = load(name)
    rng = np.random.default_rng(11)
    outcomes = {'planned': 0, 'refused': 0}
    for _ in range(GOALS):
        joints, pose = random_posture(machine, rng)
        scale = machine.kinematics.characteristic_length * rng.choice([0.005, 0.1, 1.0])
        twist = np.concatenate(
            [rng.normal(size=3) * scale, rng.normal(size=3) * rng.choice([0.02, 0.2, 1])]
        )
        goal = Goal(pose.moved(twist), motion=list(Motion)[rng.integers(3)])
        effort, start = Effort(), Start(MotionState.at_rest(pose), joints, DT)
        try:
            plan = plan_goal(machine, start, goal, effort)
        except ManipulatorError as error:
            outcomes['refused'] += 1
            assert str(error)
        else:
            outcomes['planned'] += 1
            times = np.arange(0.0, plan.duration + DT, DT)
            own = plan.joints_at(times)
            path = (
                machine.kinematics.inverse_along(plan.at(times).pose, joints)
                if own is None
                else own
            )
            speeds = np.abs(np.diff(path, axis=0)).max(axis=0) / DT
            assert (speeds <= 1.01 * machine.motion.joint.speed).all()
            np.testing.assert_allclose(path[0], joints, atol=1e-7)
        assert effort.poses <= MOST_POSES
    assert min(outcomes.values()) > 3, outcomes
