"""What a Robot takes for a pose, and what it refuses."""

from types import SimpleNamespace

import numpy as np
import pytest

from hexarm import machines
from hexarm.robot import Robot
from hexarm.robot_values import (
    Limits,
    moved_to,
    numbers_by_name,
    pose_from,
    poses_from,
    share_done,
)
from manipulator.errors import InvalidInput
from manipulator.pose import Pose

POSE = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.1, -0.2, 0.3))


def matrix(pose):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = pose.rotation, pose.position
    return T


@pytest.mark.parametrize('value', [POSE, (0.1, 0.2, 0.3, 0.1, -0.2, 0.3), matrix(POSE)])
def test_a_pose_is_a_pose_six_numbers_or_a_matrix(value):
    pose = pose_from(value)
    assert matrix(pose) == pytest.approx(matrix(POSE), abs=1e-12)


def test_three_numbers_are_a_level_pose():
    assert matrix(pose_from([1, 2, 3])) == pytest.approx(matrix(Pose.from_xyz_rpy((1, 2, 3))))


@pytest.mark.parametrize(
    ('value', 'words'),
    [
        ((1, 2), r'shape \(2,\)'),
        ('up', 'not a pose'),
        (None, 'shape'),
        ((0, 0, float('nan')), 'not finite'),
        ((0, 0, 0, 0, 0, 90), 'yaw: 90 rad is more than a turn; are these degrees'),
    ],
)
def test_what_is_no_pose_is_refused_in_words(value, words):
    with pytest.raises(InvalidInput, match=words):
        pose_from(value)


def test_poses_of_all_kinds_make_one_path():
    path = poses_from([(0, 0, 1), POSE, matrix(POSE)])
    assert path.position.shape == (3, 3)
    assert poses_from(POSE).position.shape == (1, 3)
    with pytest.raises(InvalidInput, match='without poses'):
        poses_from([])


def test_named_coordinates_replace_and_none_keeps():
    pose = moved_to(POSE, {'z': 0.5, 'yaw': -0.3, 'x': None})
    assert pose.position == pytest.approx([0.1, 0.2, 0.5])
    assert pose.rpy == pytest.approx([0.1, -0.2, -0.3])
    with pytest.raises(InvalidInput, match="z: 'high' is not a finite number"):
        moved_to(POSE, {'z': 'high'})


def test_the_share_of_a_move_is_that_of_its_shift_and_its_turn():
    start, goal = Pose.identity(), Pose.from_xyz_rpy((0.1, 0, 0), (0, 0, 1.0))
    middle = Pose.from_xyz_rpy((0.04, 0, 0), (0, 0, 0.4))
    assert share_done(start, start, goal) == 0.0
    assert share_done(start, middle, goal) == pytest.approx(0.4)
    assert share_done(start, goal, goal) == 1.0
    assert share_done(start, start, start) == 1.0


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6', 'ur5'])
def test_limits_name_every_joint(name):
    machine = machines.load(name)
    limits = Limits.of(machine)
    assert tuple(limits.joints) == machine.kinematics.joint_names == tuple(limits.joint_speeds)
    assert all(low < high for low, high in limits.joints.values())
    assert min(limits.speed, limits.turning_speed, *limits.joint_speeds.values()) > 0


def test_numbers_by_name_come_from_both_places_and_must_be_some():
    assert numbers_by_name({'joint_1': 1}, {'joint_2': 0.5}, 'joint') == {
        'joint_1': 1.0,
        'joint_2': 0.5,
    }
    with pytest.raises(InvalidInput, match='no joint is named'):
        numbers_by_name(None, {}, 'joint')
    with pytest.raises(InvalidInput, match="joint_1: 'far' is not a finite number"):
        numbers_by_name({'joint_1': 'far'}, {}, 'joint')


@pytest.mark.parametrize('wrong', [{'pause': -1.0}, {'repeat': 0}, {'speed': 0.0}])
def test_a_replay_refuses_what_no_time_or_speed_is(wrong):
    saved = SimpleNamespace(steps=lambda names: names)
    with pytest.raises(InvalidInput, match=next(iter(wrong))):
        Robot.replay(SimpleNamespace(saved_poses=saved), 'low', **wrong)
