import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import InvalidInput, Refused
from manipulator.pose import Pose
from manipulator.trajectory.pilot import Pilot
from manipulator.trajectory.player import Goal

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
ELSEWHERE = Pose.from_xyz_rpy((0.004, 0.002, 0.044), (0.0, 0.05, 0.0))


def pilot():
    return Pilot(MACHINE, 0.01, 0.2)


def see(made, pose):
    made.note_joints(MACHINE.kinematics.inverse(pose))
    made.note_pose(pose)


def driving(pose=HOME):
    made = pilot()
    made.note_machine_state('enabled', is_followed=False)
    see(made, pose)
    made.step()
    made.note_machine_state('enabled', is_followed=True)
    return made


def run(made, ticks, is_following=True):
    for _ in range(ticks):
        pose = made.step()
        if pose is not None and is_following:
            see(made, pose)
    return pose


def test_nothing_goes_out_before_the_machine_is_enabled_and_its_pose_known():
    made = pilot()
    assert made.step() is None
    see(made, HOME)
    assert made.step() is None
    made.note_machine_state('enabled', is_followed=False)
    assert made.step() is None
    with pytest.raises(Refused, match='its pose is not known'):
        _ = made.player


def test_motion_begins_where_the_joints_are():
    made = driving(ELSEWHERE)
    assert np.abs(made.step().twist_to(ELSEWHERE)).max() < 1e-12


def test_a_driver_that_stood_still_itself_drops_its_goal_and_begins_where_the_joints_are():
    made = driving()
    made.player.pursue(Goal(ELSEWHERE, 7.0))
    there = run(made, 30)
    made.note_stall(0.4)
    assert made.is_driving
    made.note_stall(0.6)
    assert made.step() is None
    assert (made.status.result, made.status.goal_stamp) == ('stopped', 7.0)
    see(made, there)
    assert np.abs(made.step().twist_to(there)).max() < 1e-12


def test_no_goal_is_taken_until_the_board_follows():
    made = pilot()
    made.note_machine_state('enabled', is_followed=False)
    see(made, HOME)
    assert made.step() is not None
    with pytest.raises(Refused, match='does not follow'):
        _ = made.player
    made.note_machine_state('enabled', is_followed=True)
    made.player.pursue(Goal(ELSEWHERE, 1.0))
    run(made, 100)
    assert made.status.result == 'reached'


@pytest.mark.parametrize('state', ['disarmed', 'stopped', 'fault', 'disconnected', 'holding'])
def test_leaving_enabled_drops_the_goal_and_the_next_motion_begins_where_the_joints_are(state):
    made = driving()
    made.player.pursue(Goal(ELSEWHERE, 7.0))
    run(made, 5)
    made.note_machine_state(state, is_followed=False)
    assert (made.status.result, made.status.goal_stamp) == ('stopped', 7.0)
    assert state in made.status.reason
    assert made.step() is None
    made.note_machine_state('enabled', is_followed=False)
    see(made, ELSEWHERE)
    assert np.abs(run(made, 20).twist_to(ELSEWHERE)).max() < 1e-12


def moving():
    made = driving()
    made.player.pursue(Goal(ELSEWHERE, 7.0))
    run(made, 8)
    return made


def test_without_a_pose_motion_brakes_on_its_way_and_goes_on_when_it_is_heard_again():
    made = moving()
    made.note_silence(0.25)
    run(made, 20)
    held = made.step()
    assert np.abs(held.twist_to(made.step())).max() < 1e-12
    assert np.abs(held.twist_to(ELSEWHERE)).max() > 1e-4
    assert made.status.result == 'moving'
    made.note_silence(0.01)
    run(made, 200)
    assert made.status.result == 'reached'


def test_after_a_long_silence_goals_are_dropped_and_motion_begins_at_a_pose_that_is_not_late():
    made = moving()
    made.note_silence(0.6)
    assert made.step() is None
    assert (made.status.result, made.status.reason) == ('stopped', 'no pose for 0.5 s')
    made.note_pose(HOME)
    with pytest.raises(Refused, match='its pose is not known'):
        _ = made.player
    see(made, HOME)
    made.player.pursue(Goal(ELSEWHERE, 8.0))
    run(made, 200)
    assert made.status.result == 'reached'


def test_holding_board_is_taken_up_again_without_asking():
    made = driving()
    made.note_machine_state('holding', is_followed=False)
    see(made, ELSEWHERE)
    assert np.abs(made.step().twist_to(ELSEWHERE)).max() < 1e-12


def test_joints_that_do_not_follow_end_the_motion_and_name_one():
    made = driving()
    made.player.pursue(Goal(Pose.from_xyz_rpy((0.0, 0.0, 0.055)), 3.0))
    for _ in range(150):
        see(made, HOME)
        if made.step() is None:
            break
    assert made.status.result == 'stopped'
    assert 'away from its command' in made.status.reason
    see(made, HOME)
    assert np.abs(made.step().twist_to(HOME)).max() < 1e-12


def test_override_is_kept_over_a_new_enabling():
    made = driving()
    made.override(0.0)
    made.note_machine_state('disarmed', is_followed=False)
    made.note_machine_state('enabled', is_followed=False)
    see(made, HOME)
    made.note_machine_state('enabled', is_followed=True)
    made.player.pursue(Goal(ELSEWHERE, 1.0))
    assert np.abs(run(made, 50).twist_to(HOME)).max() < 1e-6


def test_pivot_waits_until_the_machine_stands_still():
    made = driving()
    made.player.pursue(Goal(ELSEWHERE, 1.0))
    run(made, 3)
    made.set_pivot([0.0, 0.0, 0.05])
    run(made, 1)
    assert made.machine.frames.are_plain
    run(made, 100)
    assert not made.machine.frames.are_plain
    assert np.abs(run(made, 3).twist_to(ELSEWHERE)).max() < 1e-8


def test_pivot_that_is_no_place_is_refused():
    with pytest.raises(InvalidInput, match='pivot'):
        driving().set_pivot([float('nan'), 0.0, 0.0])


def test_goal_that_still_waited_when_the_machine_was_lost_is_named():
    made = driving()
    made.player.pursue(Goal(ELSEWHERE, 9.0))
    made.note_machine_state('disarmed', is_followed=False)
    assert (made.status.result, made.status.goal_stamp) == ('stopped', 9.0)


def test_a_new_pivot_does_not_end_a_pause():
    made = driving()
    made.pause(True)
    made.set_pivot((0.0, 0.0, 0.03))
    made.step()
    assert made.machine.frames.pivot(HOME).position[2] > HOME.position[2] + 0.02
    made.player.pursue(Goal(made.machine.frames.pivot(ELSEWHERE), 9.0))
    run(made, 100)
    assert np.abs(made.step().twist_to(HOME)).max() < 1e-9
    made.pause(False)
    run(made, 300)
    assert np.abs(made.step().twist_to(ELSEWHERE)).max() < 1e-9


def test_pause_outlasts_a_machine_that_is_lost_and_taken_over_again():
    made = driving()
    made.pause(True)
    made.note_machine_state('disarmed', is_followed=False)
    made.note_machine_state('enabled', is_followed=False)
    made.note_pose(HOME)
    made.note_machine_state('enabled', is_followed=True)
    made.player.pursue(Goal(ELSEWHERE, 1.0))
    assert np.abs(run(made, 50).twist_to(HOME)).max() < 1e-6
    made.pause(False)
    assert np.abs(run(made, 300).twist_to(ELSEWHERE)).max() < 1e-6


def test_a_stopped_machine_says_that_the_stop_must_be_cleared():
    made = driving()
    made.note_machine_state('stopped', is_followed=False)
    with pytest.raises(Refused, match='the machine is stopped: clear the stop first'):
        _ = made.player


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


def test_a_leg_bent_the_wrong_way_and_almost_straight_is_named():
    pose, joints = elbow_in_and_almost_straight()
    made = pilot()
    made.note_machine_state('enabled', is_followed=True)
    made.note_joints(joints)
    for _ in range(60):
        made.note_pose(pose)
    with pytest.raises(
        Refused, match=r'crank_\d, which is off by 0\.0\d+ rad: disable and enable'
    ):
        _ = made.player
    assert 'disable and enable it' in made.status.reason
    see(made, HOME)
    assert made.step() is not None
    assert made.player.status.reason == ''


def test_a_pose_that_is_late_for_a_moment_is_no_trouble():
    made = pilot()
    made.note_machine_state('enabled', is_followed=True)
    made.note_joints(MACHINE.kinematics.inverse(HOME))
    for _ in range(10):
        made.note_pose(ELSEWHERE)
    assert 'off by' not in made.status.reason
