"""A supervisor that stalls, receives no pose, or is not followed: how motion ends and begins."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import Refused
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest, plan_path
from manipulator.pose import Pose
from manipulator.trajectory.executor import Goal

HOME = load('robocake').kinematics.home
ELSEWHERE = Pose.from_xyz_rpy((0.004, 0.002, 0.044), (0.0, 0.05, 0.0))


def test_a_driver_that_stood_still_itself_drops_its_goal_and_begins_where_the_joints_are(driving):
    driving.executor.pursue(Goal(ELSEWHERE, 7.0))
    there = driving.run(30)
    driving.note_stall(0.4)
    assert driving.is_driving
    driving.note_stall(0.6)
    assert driving.step() is None
    assert (driving.status.result, driving.status.goal_stamp) == ('stopped', 7.0)
    driving.see(there)
    assert np.abs(driving.step().twist_to(there)).max() < 1e-12


def test_without_a_pose_motion_brakes_on_its_path_and_goes_on_when_it_is_received_again(moving):
    moving.note_silence(0.25)
    moving.run(20)
    held = moving.step()
    assert np.abs(held.twist_to(moving.step())).max() < 1e-12
    assert np.abs(held.twist_to(ELSEWHERE)).max() > 1e-4
    assert moving.status.result == 'moving'
    moving.note_silence(0.01)
    moving.run(200)
    assert moving.status.result == 'reached'


def test_after_a_long_silence_goals_are_dropped_and_motion_begins_at_a_pose_that_is_not_late(
    moving,
):
    moving.note_silence(0.6)
    assert moving.step() is None
    assert (moving.status.result, moving.status.reason) == (
        'stopped',
        'no pose received for 0.5 s',
    )
    moving.note_pose(HOME)
    with pytest.raises(Refused, match='its pose is not known'):
        _ = moving.executor
    moving.see(HOME)
    moving.executor.pursue(Goal(ELSEWHERE, 8.0))
    moving.run(200)
    assert moving.status.result == 'reached'


def test_joints_that_do_not_follow_end_the_motion_and_name_one(driving):
    driving.executor.pursue(Goal(Pose.from_xyz_rpy((0.0, 0.0, 0.055)), 3.0))
    for _ in range(150):
        driving.see(HOME)
        if driving.step() is None:
            break
    assert driving.status.result == 'stopped'
    assert 'away from its command' in driving.status.reason
    driving.see(HOME)
    assert np.abs(driving.step().twist_to(HOME)).max() < 1e-12


def test_a_goal_is_not_reached_while_the_joints_are_still_elsewhere(driving):
    high = Pose.from_xyz_rpy((0.0, 0.0, 0.049))
    driving.executor.pursue(Goal(high, 4.0))
    text = []
    while driving.step() is not None:
        driving.see(HOME)
        text.append(driving.status.result)
        assert len(text) < 300
    assert set(text) == {'moving'}
    assert driving.status.result == 'stopped'
    assert 'away from its command' in driving.status.reason


def test_how_much_of_a_path_is_over_is_reported_while_the_joints_lag_behind(driving):
    """By a quarter of a second, which is more than the tolerance of where a goal is reached."""
    inverse, joints = driving.machine.kinematics.inverse, driving.machine.kinematics.inverse(HOME)
    heights = HOME.position + np.array([[0, 0, 0], [0, 0, 0.012], [0, 0, -0.012], [0, 0, 0.012]])
    request = PathRequest(Pose(heights, np.eye(3)), 0.05, Tolerance())
    driving.executor.pursue(Goal(HOME, 5.0, plan_path(driving.machine, request, joints, 0.01)))
    commanded, said_late = [HOME] * 25, []
    while driving.status.result != 'reached':
        commanded.append(driving.step())
        driving.note_joints(inverse(commanded[-25]))
        is_late = np.abs(inverse(commanded[-1]) - inverse(commanded[-26])).max() > 0.2
        if is_late and driving.executor.status.result == 'moving':
            assert driving.status == driving.executor.status
            said_late.append(driving.status.percent)
        assert len(commanded) < 400
    assert len(set(said_late)) >= 3


def test_a_machine_whose_joints_are_not_measured_reaches_its_goals(driving):
    driving.executor.pursue(Goal(ELSEWHERE, 4.0))
    for _ in range(300):
        driving.step()
    assert (driving.status.result, driving.status.goal_stamp) == ('reached', 4.0)


def test_joints_that_come_late_reach_the_goal_when_they_are_there(driving):
    high = Pose.from_xyz_rpy((0.0, 0.0, 0.049))
    driving.executor.pursue(Goal(high, 4.0))
    while np.abs(driving.step().twist_to(high)).max() > 1e-9:
        driving.see(HOME)
    driving.step()
    assert driving.status.result == 'moving'
    driving.see(high)
    driving.step()
    assert (driving.status.result, driving.status.goal_stamp) == ('reached', 4.0)


def test_what_a_bridge_reported_that_has_died_counts_for_nothing(driving):
    driving.note_bridge_silence(1.4)
    assert driving.is_driving
    driving.note_bridge_silence(1.6)
    assert not driving.is_driving
    assert driving.status.reason == 'machine_state timed out (1.5 s)'
    driving.see(HOME)
    with pytest.raises(Refused, match='no machine_state received from serial_bridge'):
        _ = driving.executor
    driving.note_machine_state('enabled', is_followed=False)
    driving.see(HOME)
    assert driving.step() is not None
    with pytest.raises(Refused, match='does not follow setpoints yet'):
        _ = driving.executor
