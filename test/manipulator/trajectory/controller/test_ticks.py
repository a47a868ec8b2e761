"""What a tick makes of silences, of standing still and of what became of commands."""

import numpy as np
import pytest

from manipulator.deadlines import POSE_DEADLINE, POSE_PAUSE, STATE_DEADLINE
from manipulator.errors import InvalidInput
from manipulator.planning.goal import Goal
from manipulator.pose import Pose

HIGHER = Pose.from_xyz_rpy((0.0, 0.0, 0.0452))
DT = 0.01


@pytest.fixture
def moving(stage):
    """On its way to HIGHER."""
    stage.pursue(Goal(HIGHER, 7.0))
    stage.run(5)
    assert stage.status.result == 'moving'
    return stage


def test_every_tick_has_one_setpoint_also_while_nothing_moves(stage):
    before = len(stage.setpoints)
    stage.run(20)
    assert len(stage.setpoints) == before + 20


def test_a_goal_is_reached_and_each_status_is_news_once(stage):
    stage.pursue(Goal(HIGHER, 7.0))
    stage.run(200)
    assert np.abs(stage.pose.twist_to(HIGHER)).max() < 1e-9
    results = [(s.result, s.goal_stamp) for s in stage.statuses[-2:]]
    assert results == [('moving', 7.0), ('reached', 7.0)]
    assert len(stage.statuses) == len(set(stage.statuses))


def test_a_controller_that_stood_still_between_ticks_releases(moving):
    assert moving.tick(period=POSE_DEADLINE + 0.1) is None
    assert (moving.status.result, moving.status.goal_stamp) == ('stopped', 7.0)
    assert 'control loop stalled' in moving.status.reason
    moving.run(100)
    assert moving.status.result != 'reached'


def test_a_controller_that_stood_still_within_a_tick_reports_no_setpoint(moving):
    assert moving.tick(within=POSE_DEADLINE + 0.1) is None
    assert 'control loop stalled' in moving.status.reason
    moving.run(100)
    assert moving.status.result != 'reached'


def test_a_tick_that_is_a_little_late_changes_nothing(moving):
    assert moving.tick(period=0.3) is not None
    assert moving.tick(within=0.3) is not None
    moving.run(200)
    assert moving.status.result == 'reached'


def test_without_poses_it_first_pauses_and_then_releases(stage):
    stage.core.supervisor.override(0.1)
    stage.pursue(Goal(HIGHER, 7.0))
    stage.run(10)
    stage.does_pose_come = False
    stage.run(round(POSE_PAUSE / DT) + 20)
    standing = stage.setpoints[-1]
    stage.run(5)
    assert np.abs(standing.twist_to(stage.setpoints[-1])).max() == 0.0
    assert stage.status.result == 'moving'
    stage.run(round((POSE_DEADLINE - POSE_PAUSE) / DT))
    assert stage.status.reason == f'no pose received for {POSE_DEADLINE:g} s'
    assert stage.tick() is None


def note_at_higher(stage, lateness):
    """The machine was there, with its joints."""
    stage.core.note_joints(stage.machine.kinematics.inverse(HIGHER))
    stage.core.note_pose(HIGHER, stage.now, lateness)


def test_a_machine_is_taken_over_only_where_it_was_after_it_was_released(stage):
    stage.does_pose_come = False
    stage.run(round(POSE_DEADLINE / DT) + 2)
    assert stage.tick() is None
    note_at_higher(stage, lateness=0.2)
    assert stage.tick() is None
    stage.core.note_joints(stage.machine.kinematics.inverse(stage.pose))
    stage.core.note_pose(stage.pose, stage.now, lateness=0.01)
    assert np.abs(stage.tick().twist_to(stage.pose)).max() == 0.0


def test_a_machine_is_taken_over_only_where_it_was_in_its_present_state(stage):
    stage.state, stage.does_pose_come = 'playing', False
    stage.run(20)
    stage.state = 'enabled'
    stage.run(5)
    note_at_higher(stage, lateness=0.06)
    assert stage.tick() is None
    stage.core.note_joints(stage.machine.kinematics.inverse(stage.pose))
    stage.core.note_pose(stage.pose, stage.now, lateness=0.01)
    assert stage.tick() is not None


def test_a_late_pose_of_a_machine_that_is_driven_counts(moving, monkeypatch):
    noted = []
    monkeypatch.setattr(moving.core.supervisor, 'note_pose', noted.append)
    moving.core.note_pose(HIGHER, moving.now, lateness=0.4)
    assert noted == [HIGHER]


def test_without_the_bridges_word_it_releases(stage):
    stage.does_bridge_say = False
    stage.run(round(STATE_DEADLINE / DT) - 2)
    assert stage.tick() is not None
    stage.run(3)
    assert stage.tick() is None
    assert 'machine_state timed out' in stage.status.reason


def test_what_the_bridge_reported_while_the_controller_stood_still_counts_as_reported(stage):
    stage.does_bridge_say = False
    stage.run(100)  # 1 s, and then 0.4 s three times, each too short to let go
    for _ in range(3):
        assert stage.tick(period=0.4) is not None


def test_a_stop_of_the_machine_is_news_before_the_next_tick(moving):
    moving.core.note_machine_state('stopped', False, False, moving.now)
    (status,) = moving.core.news.take()
    assert (status.result, status.goal_stamp) == ('stopped', 7.0)
    assert 'stopped' in status.reason


def test_refusals_are_news_and_counted_but_do_not_end_the_motion(moving):
    news = moving.core.news
    assert (news.refusals, news.last_refusal) == (0, '')
    moving.core.refuse(8.0, InvalidInput('x is nan'))
    moving.core.refuse(8.0, InvalidInput('x is nan'))
    moving.core.refuse(9.0, InvalidInput('y is nan'))
    text = news.take()
    assert [(s.result, s.goal_stamp, s.reason) for s in text] == [
        ('refused', 8.0, 'x is nan'),
        ('refused', 9.0, 'y is nan'),
    ]
    assert (news.refusals, news.last_refusal) == (2, 'y is nan')
    moving.run(200)
    assert (moving.status.result, moving.status.goal_stamp) == ('reached', 7.0)


def test_sticks_move_the_machine_until_they_fall_silent(stage):
    twist = np.array([0.01, 0.0, 0.0, 0.0, 0.0, 0.0])
    for _ in range(20):
        stage.core.teleop.receive('cmd_vel/joy', twist, '', stage.now)
        stage.tick()
    assert stage.status.mode == 'jog'
    stage.run(100)
    assert stage.status.mode == 'hold'
    assert stage.pose.position[0] > 0.0005


def test_lateness_of_the_ticks_is_measured(stage):
    assert stage.core.jitter.quantile(0.99) == pytest.approx(0.0, abs=1e-9)
    stage.tick(period=DT + 0.05)
    assert stage.core.jitter.quantile(1.0) == pytest.approx(0.05)
