"""When a supervisor takes its machine over, from where, and why it does not."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import Refused
from manipulator.pose import Pose
from manipulator.trajectory.executor import Goal

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
ELSEWHERE = Pose.from_xyz_rpy((0.004, 0.002, 0.044), (0.0, 0.05, 0.0))


def test_nothing_goes_out_before_the_machine_is_enabled_and_its_pose_known(supervisor):
    assert supervisor.step() is None
    supervisor.see(HOME)
    assert supervisor.step() is None
    supervisor.note_machine_state('enabled', is_followed=False)
    assert supervisor.step() is None
    with pytest.raises(Refused, match='its pose is not known'):
        _ = supervisor.executor


def test_no_goal_is_taken_until_the_board_follows(supervisor):
    supervisor.note_machine_state('enabled', is_followed=False)
    supervisor.see(HOME)
    assert supervisor.step() is not None
    with pytest.raises(Refused, match='does not follow'):
        _ = supervisor.executor
    supervisor.note_machine_state('enabled', is_followed=True)
    supervisor.executor.pursue(Goal(ELSEWHERE, 1.0))
    supervisor.run(100)
    assert supervisor.status.result == 'reached'


def test_a_machine_that_was_never_enabled_is_disabled_and_reports_that_of_no_goal(supervisor):
    text = supervisor.status
    assert (text.mode, text.result, text.goal_stamp) == ('disabled', 'idle', 0.0)
    assert text.reason == 'the servos are not enabled'


@pytest.mark.parametrize('is_followed', [False, True])
def test_a_machine_that_is_taken_over_holds_once_its_board_follows(supervisor, is_followed):
    supervisor.note_machine_state('enabled', is_followed)
    supervisor.see(HOME)
    assert supervisor.is_driving
    expected = ('hold', '') if is_followed else ('disabled', 'does not follow setpoints yet')
    assert supervisor.status.mode == expected[0]
    assert supervisor.status.reason.endswith(expected[1])
    assert (supervisor.status.reason == '') == is_followed


def test_motion_begins_where_the_joints_are(supervisor):
    supervisor.enable_at(ELSEWHERE)
    assert np.abs(supervisor.step().twist_to(ELSEWHERE)).max() < 1e-12


@pytest.mark.parametrize('state', ['disarmed', 'stopped', 'fault', 'disconnected', 'holding'])
def test_leaving_enabled_drops_the_goal_and_the_next_motion_begins_where_the_joints_are(
    driving, state
):
    driving.executor.pursue(Goal(ELSEWHERE, 7.0))
    driving.run(5)
    driving.note_machine_state(state, is_followed=False)
    assert (driving.status.result, driving.status.goal_stamp) == ('stopped', 7.0)
    assert state in driving.status.reason
    assert driving.step() is None
    driving.note_machine_state('enabled', is_followed=False)
    driving.see(ELSEWHERE)
    assert np.abs(driving.run(20).twist_to(ELSEWHERE)).max() < 1e-12


def test_holding_board_is_taken_up_again_without_asking(driving):
    driving.note_machine_state('holding', is_followed=False)
    driving.see(ELSEWHERE)
    assert np.abs(driving.step().twist_to(ELSEWHERE)).max() < 1e-12


def test_goal_that_still_waited_when_the_machine_was_lost_is_named(driving):
    driving.executor.pursue(Goal(ELSEWHERE, 9.0))
    driving.note_machine_state('disarmed', is_followed=False)
    assert (driving.status.result, driving.status.goal_stamp) == ('stopped', 9.0)


def test_what_became_of_a_goal_is_still_reported_once_the_machine_is_taken_over_again(moving):
    moving.note_machine_state('holding', is_followed=False)
    moving.see(ELSEWHERE)
    moving.note_machine_state('enabled', is_followed=True)
    moving.run(20)
    text = moving.status
    assert (text.mode, text.result, text.goal_stamp) == ('hold', 'stopped', 7.0)
    assert 'holding' in text.reason
    moving.executor.pursue(Goal(HOME, 8.0))
    moving.run(200)
    assert (moving.status.result, moving.status.goal_stamp) == ('reached', 8.0)


def test_a_machine_that_is_enabled_anew_is_idle(moving):
    moving.note_machine_state('disarmed', is_followed=False)
    moving.note_machine_state('arming', is_followed=False)
    assert moving.status.result == 'stopped'
    moving.enable_at(ELSEWHERE)
    moving.run(20)
    assert (moving.status.mode, moving.status.result) == ('hold', 'idle')


@pytest.mark.parametrize(
    ('state', 'remedy'),
    [
        ('stopped', 'clear the stop first'),
        ('disconnected', 'the board does not answer'),
        ('disarmed', 'enable it first'),
    ],
)
def test_a_machine_that_nobody_may_drive_reports_what_is_missing(driving, state, remedy):
    driving.note_machine_state(state, is_followed=False)
    with pytest.raises(Refused, match=f'the machine is {state}: {remedy}'):
        _ = driving.executor


def elbow_in_and_almost_straight():
    """A pose at the edge of the reach, and joints of which the straightest leg is bent inwards."""
    inside, outside = 0.0, 0.1
    while outside - inside > 1e-7:
        middle = 0.5 * (inside + outside)
        pose = Pose.from_xyz_rpy(HOME.position + np.array([0.0, 0.0, middle]), (0.0, 0.0, 0.1))
        closes = np.isfinite(MACHINE.kinematics.inverse_or_nan(pose)).all()
        inside, outside = (middle, outside) if closes else (inside, middle)
    pose = Pose.from_xyz_rpy(HOME.position + np.array([0.0, 0.0, inside - 1e-5]), (0.0, 0.0, 0.1))
    out, *others = MACHINE.kinematics.inverse_all(pose)
    one_in = [joints for joints in others if np.count_nonzero(joints != out) == 1]
    return pose, min(one_in, key=lambda joints: np.abs(joints - out).max())


def test_a_leg_bent_the_wrong_way_and_almost_straight_is_named(supervisor):
    pose, joints = elbow_in_and_almost_straight()
    supervisor.note_machine_state('enabled', is_followed=True)
    supervisor.note_joints(joints)
    for _ in range(60):
        supervisor.note_pose(pose)
    with pytest.raises(
        Refused, match=r'crank_\d, which differs by 0\.0\d+ rad: disable and enable'
    ):
        _ = supervisor.executor
    assert 'disable and enable it' in supervisor.status.reason
    supervisor.note_machine_state('disarmed', is_followed=False)
    assert 'disable and enable it' not in supervisor.status.reason
    supervisor.note_machine_state('enabled', is_followed=True)
    supervisor.see(HOME)
    assert supervisor.step() is not None
    assert supervisor.executor.status.reason == ''


def test_a_pose_that_is_late_for_a_moment_is_no_violation(supervisor):
    supervisor.note_machine_state('enabled', is_followed=True)
    supervisor.note_joints(MACHINE.kinematics.inverse(HOME))
    for _ in range(10):
        supervisor.note_pose(ELSEWHERE)
    assert 'off by' not in supervisor.status.reason
