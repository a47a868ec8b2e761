"""Sticks, and who has the machine."""

import itertools

import numpy as np
import pytest

from bridge.protocol import Setpoint
from world.requests import Requests

FORWARD = np.array([0.01, 0.0, 0.0, 0.0, 0.0, 0.0])
UP = np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
JOY = 'cmd_vel/joy'
QUIET = 2.0
"""Counts: roundings, not motion."""


def hold(world, twist, seconds, source=JOY):
    """A stick that is held for so long, and not let go."""
    end = world.now + seconds
    while world.now < end:
        world.links['twists'].send(world.user.stamp, source, np.array(twist, dtype=float))
        world.run(0.02)


def last_change(world, since):
    """When the setpoint frames changed for the last time."""
    frames = world.frames(Setpoint, since)
    pairs = itertools.pairwise(frames)
    return [at for (_, old), (at, new) in pairs if new.counts != old.counts][-1]


@pytest.fixture
def arm(make_world):
    """On stepper drives with encoders."""
    return make_world('arm_6r_stepper')


def test_a_jog_moves_while_it_is_held_and_stops_at_release(world):
    world.jog(FORWARD, 0.4)
    world.run(0.5)
    there = world.pose.position[0]
    assert there > 0.002
    world.run(1.0)
    assert world.pose.position[0] == pytest.approx(there, abs=2e-4)


def test_release_stops_an_arm_at_full_speed_within_a_third_of_a_second(arm):
    since = arm.now
    arm.jog([0.2, 0, 0, 0, 0, 0], 1.0, JOY)
    assert arm.status.mode == 'jog'
    released = arm.now
    arm.run(1.0)
    assert last_change(arm, since) - released < 0.35
    assert (arm.status.mode, arm.status.result) == ('hold', 'idle')
    assert_smooth(arm, since)


def assert_smooth(arm, since):
    """No change of position or velocity beyond the joints' limits, from frame to frame."""
    limits = arm.machine.motion.joint
    channels = [arm.calibration.names.index(n) for n in arm.machine.kinematics.joint_names]
    scale = np.abs(np.array(arm.calibration.scale))[channels]
    joints = arm.setpoints(since)[:, channels] / scale
    steps, rounding = np.diff(joints, axis=0), 1.0 / scale
    assert (np.abs(steps) <= 1.01 * limits.speed * 0.01 + rounding).all()
    changes = np.abs(np.diff(steps, axis=0))
    assert (changes <= 1.05 * limits.acceleration * 1e-4 + 2 * rounding).all()


def test_a_stick_that_falls_silent_stops_the_machine(world):
    world.links['twists'].send(world.user.stamp, 'cmd_vel/joy', FORWARD)
    world.run(0.25 + 0.3)
    there = world.pose.position[0]
    world.run(1.0)
    assert there > 0.001
    assert world.pose.position[0] == pytest.approx(there, abs=2e-4)


def test_a_person_takes_the_machine_from_the_computer_which_must_release_first(world):
    world.jog(FORWARD, 0.2, 'cmd_vel')
    for _ in range(10):  # both hold: a person's twist leads backwards
        world.links['twists'].send(world.user.stamp, 'cmd_vel/joy', -FORWARD)
        world.run(0.02)
        world.links['twists'].send(world.user.stamp, 'cmd_vel', FORWARD)
        world.run(0.02)
    assert world.controller.teleop.owner(world.now) == 'cmd_vel/joy'
    reasons = [reason for _, reason in world.controller.on_twist.refusals]
    assert any('cmd_vel/joy took over the machine' in reason for reason in reasons)


def test_a_stick_overrides_a_goal_in_motion_smoothly_and_the_goal_does_not_resume(arm):
    since = arm.now
    home = arm.machine.kinematics.home
    stamp = arm.send_goal(home.moved([0.25, 0, 0, 0, 0, 0]))
    arm.wait('5 cm', lambda: arm.pose.position[0] > home.position[0] + 0.05)
    assert arm.status.mode == 'move'
    hold(arm, UP, 1.0)
    reported = [(s.goal_stamp, s.result, s.mode) for _, s in arm.controller.statuses]
    assert (stamp, 'moving', 'move') in reported
    assert reported[-1][1:] == ('moving', 'jog')
    refused = arm.send_goal(home)
    hold(arm, UP, 0.1)
    assert any(
        s.goal_stamp == refused and f'{JOY} controls the machine' in s.reason
        for _, s in arm.controller.statuses
    )
    hold(arm, np.zeros(6), 0.02)
    arm.run(1.0)
    rest = arm.now
    arm.run(1.0)
    assert arm.moved(rest) <= QUIET
    assert arm.status.mode == 'hold'
    assert arm.pose.position[2] > home.position[2] + 0.03
    assert arm.pose.position[0] < home.position[0] + 0.2
    assert_smooth(arm, since)


def test_a_stop_ends_a_jog_until_the_stick_is_released(arm):
    hold(arm, 0.5 * UP, 0.3)
    Requests(arm).stop()
    hold(arm, 0.5 * UP, 0.6)
    assert (arm.status.mode, arm.status.result) == ('hold', 'stopped')
    arm.run(0.5)
    hold(arm, -0.5 * UP, 0.3)
    assert arm.status.mode == 'jog'


def test_a_twist_above_the_limits_is_scaled_and_reported(arm):
    hold(arm, 20 * UP, 0.3)
    assert 'scaled to' in arm.status.reason
    assert 'speed limits' in arm.status.reason
    way = arm.pose.position - arm.machine.kinematics.home.position
    assert way[2] > 0.01
    assert np.abs(way[:2]).max() < 0.1 * way[2]


def test_twists_for_a_machine_that_is_lost_do_not_count_when_it_is_back(world):
    hold(world, FORWARD, 0.3)
    world.emergency_stop()
    hold(world, FORWARD, 0.3)
    assert world.clear() == ''
    world.wait('hold', lambda: world.status.mode == 'hold')
    since = world.now
    hold(world, FORWARD, 1.0)
    assert world.moved(since) <= QUIET
    world.run(0.5)
    hold(world, FORWARD, 0.3)
    assert world.status.mode == 'jog'
