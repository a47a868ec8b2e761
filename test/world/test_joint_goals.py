"""Goals of joints: any of them, within every limit, through postures that fix no joints."""

import re

import numpy as np
import pytest

from manipulator.planning.check import TOLERANCE
from manipulator.planning.goal import Goal, Motion

DEAD_BAND = 0.008
"""rad or m by which the dead bands of the servos may miss a goal."""


def joint(world, number):
    return world.machine.kinematics.joint_names[number - 1]


@pytest.mark.parametrize('name', ['arm_6r', 'ur5', 'robocake', 'stewart_6_6'])
def test_named_joints_arrive_and_the_others_stay(make_world, name):
    world = make_world(name, hysteresis=0.0)
    before = world.joints
    low, high = world.machine.joint_ranges
    goal = before.copy()
    goal[[0, 2]] += 0.02 * np.minimum(high - low, np.pi)[[0, 2]]
    named = {joint(world, 1): goal[0], joint(world, 3): goal[2]}
    stamp = world.send_goal_joints(**named)
    assert world.end_of(stamp).result == 'reached'
    world.run(0.3)
    assert np.abs(world.joints - goal).max() < DEAD_BAND


def test_all_joints_move_in_proportion_and_none_exceeds_its_limits(make_world):
    arm = make_world('arm_6r_stepper')
    arm.end_of(arm.send_goal_joints(joint_1=0.4, joint_4=-0.8, joint_6=0.2))
    rows = np.array([q for _, q in arm.controller.requested])
    way = rows[-1] - rows[0]
    share = (rows - rows[0]) @ way / (way @ way)
    assert np.abs(rows - rows[0] - share[:, None] * way).max() < 1e-9
    limits = arm.machine.motion.for_plans.joint
    rates = np.diff(rows, axis=0) / 0.01
    assert (np.abs(rates) <= TOLERANCE * limits.speed).all()
    pulls = np.diff(rates, axis=0) / 0.01
    assert (np.abs(pulls) <= 1.02 * limits.acceleration).all()


def test_a_turn_more_is_unwound(make_world):
    arm = make_world('ur5')
    home = arm.joints[5]
    assert arm.end_of(arm.send_goal_joints(joint_6=home + 2 * np.pi)).result == 'reached'
    arm.run(0.3)
    assert arm.joints[5] == pytest.approx(home + 2 * np.pi, abs=DEAD_BAND)
    assert arm.end_of(arm.send_goal_joints(joint_6=home)).result == 'reached'
    arm.run(0.3)
    assert arm.joints[5] == pytest.approx(home, abs=DEAD_BAND)


def test_a_pose_is_reached_with_the_turns_of_home_where_that_is_asked_for(make_world):
    arm = make_world('ur5')
    home = arm.joints
    named = {'joint_6': home[5] + 2 * np.pi, 'joint_1': home[0] + 0.2}
    assert arm.end_of(arm.send_goal_joints(**named)).result == 'reached'
    goal = Goal(arm.machine.kinematics.home, arm.user.stamp, motion=Motion.UNWIND)
    arm.controller.core.pursue(goal, lambda error: None, arm.now)
    assert arm.end_of(goal.stamp).result == 'reached'
    arm.run(0.3)
    assert np.abs(arm.joints - home).max() < DEAD_BAND


def test_the_named_joint_moves_where_its_axis_is_in_line_with_another(make_world):
    arm = make_world('arm_6r_stepper')
    assert arm.end_of(arm.send_goal_joints(joint_5=0.0)).result == 'reached'
    arm.run(0.5)
    before = arm.joints
    assert arm.end_of(arm.send_goal_joints(joint_4=before[3] + 0.3)).result == 'reached'
    arm.run(0.5)
    assert np.abs(arm.joints - before - [0, 0, 0, 0.3, 0, 0]).max() < DEAD_BAND


@pytest.mark.parametrize(
    ('name', 'named', 'reason'),
    [
        ('arm_6r', {'joint_2': 3.0}, r'joint_2.*outside'),
        ('arm_6r', {'elbow': 0.1}, r"joint 'elbow' is unknown, needs joint_1, "),
        ('arm_6r', {'joint_2': float('nan')}, r'joint_2 is nan, needs a finite number'),
        ('arm_6r', {}, r'no joint is named'),
        (
            'robocake',
            {'crank_1': 3.5, 'crank_2': 3.5, 'crank_3': 0.7, 'crank_4': 0.7},
            'these joints, together with the others, fix no pose',
        ),
        ('stewart_6_6', {'leg_1': 0.233, 'leg_4': 0.147}, 'leg 2: platform joint swing'),
    ],
)
def test_what_cannot_be_is_refused_by_name_and_the_next_goal_works(
    make_world, name, named, reason
):
    world = make_world(name)
    since = world.now
    names = world.machine.kinematics.joint_names
    refused = world.end_of(world.send_goal_joints(**named))
    assert refused.result == 'refused'
    assert re.search(reason, refused.reason)
    assert world.moved(since) <= 1.0
    near = {names[0]: world.joints[0] + 0.005}
    assert world.end_of(world.send_goal_joints(**near)).result == 'reached'


def test_a_goal_of_joints_in_motion_brakes_first_and_keeps_the_end_of_the_other(make_world):
    arm = make_world('arm_6r_stepper')
    arm.send_goal_joints(joint_1=0.5)
    arm.run(0.4)
    assert arm.status.mode == 'move'
    assert arm.end_of(arm.send_goal_joints(joint_6=0.3)).result == 'reached'
    arm.run(0.5)
    assert arm.joints[[0, 5]] == pytest.approx([0.5, 0.3], abs=DEAD_BAND)


def test_joints_that_a_rule_chooses_are_refused_one_by_one(make_world):
    stack = make_world('stack_6_6')
    since, name = stack.now, joint(stack, 1)
    refused = stack.end_of(stack.send_goal_joints(**{name: stack.joints[0] + 0.001}))
    assert 'joints cannot be commanded one by one' in refused.reason
    stack.links['joint_rates'].send(stack.user.stamp, 'cmd_vel', {name: 0.001})
    stack.run(0.1)
    assert 'joints cannot be commanded' in stack.controller.on_joint_rates.refusals[-1][1]
    assert stack.moved(since) <= 1.0
