"""Goals from the user's words to the servos and back."""

import re

import numpy as np
import pytest

from bridge.protocol import Setpoint
from hexarm import machines
from manipulator.pose import Pose

NEAR = {
    'robocake': 5e-4,
    'stewart_6_6': 5e-4,
    'stewart_6_3': 5e-4,
    'arm_6r': 3e-3,
    'arm_6r_stepper': 5e-4,
}
"""Metres by which the dead bands of a machine's servos, at its length, may miss a goal."""

STROKE = r'leg \d: leg length 0\.2\d+ m outside \[0\.142, 0\.238\]'


def near_home(world, share):
    """A pose a little away from home, by a share of the machine's length."""
    kinematics = world.machine.kinematics
    length = kinematics.characteristic_length
    return kinematics.home.moved(share * np.array([length, -length, length, 0.5, 0.5, 0.5]))


@pytest.mark.parametrize('name', NEAR)
def test_a_goal_is_reached_and_the_machine_is_there(make_world, name):
    world = make_world(name)
    goal = near_home(world, 0.03)
    assert world.go_to(goal).result == 'reached'
    world.run(0.3)
    assert np.abs(world.pose.twist_to(goal)[:3]).max() < NEAR[name]
    assert np.abs(world.pose.twist_to(goal)[3:]).max() < 0.01


@pytest.mark.parametrize(
    ('name', 'way', 'reason'),
    [
        ('robocake', (0.05, 0.0, 0.0), 'leg'),
        ('robocake', (0.0, 0.0, -0.03), 'height'),
        ('stewart_6_6', (0.0, 0.0, 0.07), STROKE),
        ('stewart_6_3', (0.0, 0.0, 0.07), STROKE),
        ('arm_6r', (1.0, 0.0, 0.0), 'reach is'),
    ],
)
def test_unreachable_goal_is_refused_with_its_reason_and_the_next_one_works(
    make_world, name, way, reason
):
    world = make_world(name)
    refused = world.go_to(world.machine.kinematics.home.moved([*way, 0.0, 0.0, 0.0]))
    assert refused.result == 'refused'
    assert re.search(reason, refused.reason)
    assert world.go_to(near_home(world, 0.01)).result == 'reached'


def test_goal_for_a_machine_that_is_not_enabled_is_refused(world):
    assert world.disable() == ''
    world.wait('release', lambda: world.status.mode == 'disabled')
    refused = world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043)))
    assert 'enable it first' in refused.reason
    world.enable()
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043))).result == 'reached'


@pytest.mark.parametrize('offset', [-3600.0, 3600.0])
def test_a_goal_from_a_computer_with_another_clock_is_reached(world, offset):
    world.user.clock_offset = offset
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043))).result == 'reached'


@pytest.mark.parametrize('offset', [-3600.0, 3600.0])
def test_a_source_whose_clock_is_set_is_believed_with_its_second_goal(world, offset):
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043))).result == 'reached'
    world.user.clock_offset = offset
    world.send_goal(Pose.from_xyz_rpy((0.001, 0.0, 0.044)))
    world.run(0.2)
    assert world.go_to(Pose.from_xyz_rpy((0.004, 0.0, 0.044))).result == 'reached'


def test_an_old_goal_is_refused_and_the_next_one_works(world):
    assert world.go_to(Pose.from_xyz_rpy((0.002, 0.0, 0.044))).result == 'reached'
    world.user.clock_offset = -30.0
    refused = world.go_to(Pose.from_xyz_rpy((0.006, 0.0, 0.044)))
    assert (refused.result, '30.000 s old, at most 0.5 s' in refused.reason) == ('refused', True)
    world.user.clock_offset = 0.0
    assert world.go_to(Pose.from_xyz_rpy((0.003, 0.0, 0.044))).result == 'reached'


def test_goals_at_2_khz_are_pursued_newest_first_and_the_loop_goes_on(world):
    since = world.now
    for k in range(2000):
        stamp = world.send_goal(Pose.from_xyz_rpy((0.008 * k / 2000, 0.0, 0.044)))
        world.run(0.0005)
    world.wait('last goal', lambda: world.status.goal_stamp == stamp)
    world.wait('end', lambda: world.status.result == 'reached')
    assert world.pose.position[0] == pytest.approx(0.008, abs=5e-4)
    times = [t for t, _ in world.frames(Setpoint, since)]
    assert max(np.diff(times)) < 0.03


def test_speed_override_zero_stands_still_and_one_goes_on(world):
    world.controller.supervisor.override(0.0)
    stamp = world.send_goal(Pose.from_xyz_rpy((0.008, 0.0, 0.0412)))
    world.run(0.5)
    assert abs(world.pose.position[0]) < 1e-4
    world.controller.supervisor.override(1.0)
    world.wait('goal', lambda: world.status.result == 'reached')
    assert world.status.goal_stamp == stamp


def test_a_goal_of_a_compensated_machine_is_reached(make_world, tmp_path):
    """The board reports joints with what compensation adds: here more than a goal's tolerance."""
    path = tmp_path / 'loaded.yaml'
    text = machines.text_of(machines.find('robocake'))
    changes = ('compensation: false', 'compensation: true'), ('mass_g: ', 'mass_g: 2')
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    world = make_world(str(path))
    goal = near_home(world, 0.03)
    there = world.machine.kinematics.inverse(goal)
    added = world.machine.deflection(goal, there)
    assert np.abs(added).max() > np.radians(0.5)
    assert world.go_to(goal).result == 'reached'
