"""Goals from the user's words to the servos and back."""

import numpy as np
import pytest

from manipulator.pose import Pose

NEAR = {'robocake': 5e-4, 'stewart_6_6': 5e-4, 'arm_6r': 3e-3}
"""Metres by which the dead bands of a machine's servos, at its length, may miss a goal."""


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
    ('xyz', 'reason'),
    [((0.05, 0.0, 0.0412), 'leg'), ((0.0, 0.0, 0.01), 'height')],
)
def test_unreachable_goal_is_refused_with_its_reason_and_the_next_one_works(world, xyz, reason):
    refused = world.go_to(Pose.from_xyz_rpy(xyz))
    assert refused.result == 'refused'
    assert reason in refused.reason
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043))).result == 'reached'


def test_goal_for_a_machine_that_is_not_enabled_is_refused(world):
    assert world.disable() == ''
    world.wait('release', lambda: world.status.mode == 'disabled')
    refused = world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043)))
    assert 'enable it first' in refused.reason
    world.enable()
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043))).result == 'reached'


def test_a_goal_from_a_computer_with_another_clock_is_reached(world):
    world.user.clock_offset = -3600.0
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043))).result == 'reached'


def test_speed_override_zero_stands_still_and_one_goes_on(world):
    world.supervisor.pilot.override(0.0)
    stamp = world.send_goal(Pose.from_xyz_rpy((0.008, 0.0, 0.0412)))
    world.run(0.5)
    assert abs(world.pose.position[0]) < 1e-4
    world.supervisor.pilot.override(1.0)
    world.wait('goal', lambda: world.status.result == 'reached')
    assert world.status.goal_stamp == stamp
