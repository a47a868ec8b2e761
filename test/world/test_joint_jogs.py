"""Jogging joint by joint: the deadman, the limits, who has the machine."""

import numpy as np
import pytest

from world.requests import Requests

JOY, PANEL, COMPUTER = 'cmd_vel/joy', 'cmd_vel/panel', 'cmd_vel'
FORWARD = np.array([0.05, 0.0, 0.0, 0.0, 0.0, 0.0])


def hold(world, seconds, source=JOY, **named):
    """A button that is held for so long, and not let go."""
    end = world.now + seconds
    while world.now < end:
        world.links['joint_rates'].send(world.user.stamp, source, named)
        world.run(0.02)


@pytest.fixture
def arm(make_world):
    """On stepper drives with encoders, whose play is none."""
    return make_world('arm_6r_stepper', hysteresis=0.0)


def rows(world):
    return np.array([q for _, q in world.controller.requested])


def test_a_joint_turns_while_it_is_held_and_stops_when_its_source_falls_silent(arm):
    before = arm.joints
    hold(arm, 0.8, joint_6=0.3)
    assert arm.status.mode == 'jog'
    arm.run(0.8)
    assert (arm.status.mode, arm.status.result) == ('hold', 'idle')
    moved = arm.joints - before
    assert 0.2 < moved[5] < 0.4
    assert np.abs(moved[:5]).max() < 2e-3
    limits, rates = arm.machine.motion.joint, np.diff(rows(arm), axis=0) / 0.01
    assert (np.abs(rates) <= 1.01 * limits.speed).all()
    assert (np.abs(np.diff(rates, axis=0)) / 0.01 <= 1.01 * limits.acceleration).all()


def test_a_joint_turns_where_its_axis_is_in_line_with_another(arm):
    assert arm.end_of(arm.send_goal_joints(joint_5=0.0)).result == 'reached'
    arm.run(0.3)
    before = arm.joints
    hold(arm, 0.8, joint_4=-0.3)
    arm.run(0.8)
    moved = arm.joints - before
    assert -0.4 < moved[3] < -0.2
    assert np.abs(moved[[0, 1, 2, 4, 5]]).max() < 2e-3


def test_an_arm_stops_at_the_end_of_a_range_and_the_way_back_is_free(arm):
    high = arm.machine.joint_ranges[1][1]
    arm.end_of(arm.send_goal_joints(joint_2=high - 0.05))
    hold(arm, 1.5, joint_2=0.5)
    assert 'joint angle of joint 2' in arm.status.reason
    assert high - 0.01 < rows(arm)[-1][1] <= high
    hold(arm, 0.5, joint_2=-0.3)
    assert arm.joints[1] < high - 0.05


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6'])
def test_a_platform_stops_before_its_joints_leave_a_limit_and_the_way_back_is_free(
    make_world, name
):
    world = make_world(name)
    names = world.machine.kinematics.joint_names
    fast = float(np.min(world.machine.motion.joint.speed))
    hold(world, 4.0, **{names[0]: fast})
    assert 'scaled to 0' in world.status.reason
    there = rows(world)
    for joints in there[::10]:
        pose = world.machine.kinematics.forward_along(joints[None], world.pose)[0]
        assert world.machine.constraints.admits(pose, joints)
    hold(world, 0.6, **{names[0]: -fast})
    assert rows(world)[-1][0] < there[-1][0] - 1e-3


def test_a_twist_of_the_same_source_takes_over_from_rest(arm):
    hold(arm, 0.5, joint_1=0.5)
    since = len(arm.controller.requested)
    end = arm.now + 0.8
    while arm.now < end:
        arm.links['twists'].send(arm.user.stamp, JOY, FORWARD)
        arm.run(0.02)
    assert arm.status.mode == 'jog'
    assert np.abs(np.diff(rows(arm)[since:], axis=0)[-1]).max() < 1e-3
    assert len(arm.controller.requested) - since < 60


def test_a_person_takes_the_joints_from_the_computer_and_a_goal_is_refused_meanwhile(arm):
    hold(arm, 0.3, COMPUTER, joint_1=0.2)
    for _ in range(10):
        arm.links['joint_rates'].send(arm.user.stamp, PANEL, {'joint_1': -0.2})
        arm.run(0.02)
        arm.links['joint_rates'].send(arm.user.stamp, COMPUTER, {'joint_1': 0.2})
        arm.run(0.02)
    assert arm.controller.teleop.owner(arm.now) == PANEL
    stamp = arm.send_goal_joints(joint_1=0.0)
    hold(arm, 0.1, PANEL, joint_1=-0.2)
    refused = [s for _, s in arm.controller.statuses if s.goal_stamp == stamp]
    assert refused[-1].reason == f'{PANEL} controls the machine'


def test_a_stop_ends_a_jog_of_joints_until_its_source_has_released(arm):
    hold(arm, 0.3, joint_1=0.3)
    Requests(arm).stop()
    hold(arm, 0.6, joint_1=0.3)
    assert (arm.status.mode, arm.status.result) == ('hold', 'stopped')
    arm.run(0.5)
    hold(arm, 0.2, joint_1=-0.3)
    assert arm.status.mode == 'jog'


@pytest.mark.parametrize(
    ('named', 'reason'),
    [
        ({'joint_9': 0.1}, "joint 'joint_9' is unknown, needs joint_1, "),
        ({}, 'no joint is named'),
        ({'joint_2': float('inf')}, 'rate of joint_2 is inf, needs a finite number'),
    ],
)
def test_bad_rates_are_refused_by_name_nothing_moves_and_the_next_ones_count(arm, named, reason):
    since = arm.now
    hold(arm, 0.2, **named)
    assert reason in arm.controller.on_joint_rates.refusals[-1][1]
    assert arm.moved(since) <= 1.0
    hold(arm, 0.2, joint_1=0.1)
    assert arm.status.mode == 'jog'
