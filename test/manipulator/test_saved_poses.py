"""The file of saved poses: what is written is read again, what a user wrote stays."""

import numpy as np
import pytest

from hexarm import machines
from manipulator.errors import ConfigError, InvalidInput
from manipulator.pose import Pose
from manipulator.saved_poses import MOST_POSES, SavedPose, SavedPoses, Step

JOINTS = np.linspace(-1.5, 2.5, 6)
POSE = Pose.from_xyz_rpy((0.1, -0.2, 0.3), (0.1, -0.2, 3.0))
EDITED = """\
# my machine
poses:
  # above the cup
  up: {xyz_mm: [1, 2, 3], rpy_deg: [0, 0, 90], joints_deg: [1, 2, 3, 4, 5, 6]}
sequences:   # by hand
  wave: [up, {pose: up, speed_mm_s: 20, pause_s: 0.5}]
"""


@pytest.fixture(scope='module')
def empty():
    return SavedPoses.none_of(machines.load('arm_6r'))


def test_what_is_saved_is_read_again_to_a_millionth_of_a_millimetre_and_degree(empty):
    text = empty.with_pose('höhe-1', SavedPose(POSE, JOINTS)).text
    again = empty.read(text).of('höhe-1')
    assert again.pose.position == pytest.approx(POSE.position, abs=1e-9)
    assert again.pose.rotation == pytest.approx(POSE.rotation, abs=2e-8)
    assert again.joints == pytest.approx(JOINTS, abs=2e-8)


def test_a_pose_may_be_without_joints(empty):
    saved = empty.read('poses:\n  up: {xyz_mm: [0, 0, 300], rpy_deg: [0, 0, 90]}\n')
    assert saved.of('up').joints is None
    again = empty.read(saved.with_pose('down', saved.of('up')).text)
    assert again.of('down').joints is None
    assert again.of('down').pose.rpy == pytest.approx([0.0, 0.0, np.pi / 2])


def test_names_that_yaml_takes_for_something_else_stay_names(empty):
    saved = empty
    for name in ('yes', 'null', 'on', 'e1'):
        saved = saved.with_pose(name, SavedPose(POSE, JOINTS))
    assert list(empty.read(saved.text).poses) == ['yes', 'null', 'on', 'e1']


def test_a_change_leaves_comments_and_sequences_as_the_user_wrote_them(empty):
    edited = empty.read(EDITED)
    changed = edited.with_pose('down', SavedPose(POSE, JOINTS)).text
    for line in ('# my machine', '  # above the cup', EDITED.splitlines()[-1]):
        assert line in changed.splitlines()
    assert empty.read(changed).sequences == edited.sequences
    assert empty.read(changed).of('up').pose.position == pytest.approx([1e-3, 2e-3, 3e-3])


def test_poses_and_sequences_make_steps(empty):
    steps = empty.read(EDITED).steps(['up', 'wave'])
    assert steps == (Step('up'), Step('up'), Step('up', speed_mm_s=20.0, pause_s=0.5))
    assert steps[2].speed == pytest.approx(0.02)


def test_the_last_pose_can_be_deleted_and_another_saved(empty):
    saved = empty.with_pose('a', SavedPose(POSE, JOINTS)).without('a')
    assert not empty.read(saved.text).poses
    assert list(empty.read(saved.with_pose('b', SavedPose(POSE, JOINTS)).text).poses) == ['b']


def test_free_names_are_counted_up(empty):
    saved = empty
    for _ in range(3):
        saved = saved.with_pose(saved.free_name(), SavedPose(POSE, JOINTS))
    assert list(saved.without('pose_2').poses) == ['pose_1', 'pose_3']
    assert saved.without('pose_2').free_name() == 'pose_2'


@pytest.mark.parametrize('name', ['', '1', 'a b', 'a:b', 'ä' * 41, 'x\n', None, True])
def test_what_is_no_name_is_refused_by_name(empty, name):
    with pytest.raises(InvalidInput, match='is not a name of a pose'):
        empty.with_pose(name, SavedPose(POSE, JOINTS))


def test_what_is_not_there_and_what_a_sequence_needs_is_not_deleted(empty):
    edited = empty.read(EDITED)
    with pytest.raises(InvalidInput, match=r"'do' \(there are: up\)"):
        edited.without('do')
    with pytest.raises(InvalidInput, match='a step of the sequence wave'):
        edited.without('up')


def test_a_full_file_takes_no_more(empty):
    saved = empty
    full = {f'p{k}': SavedPose(POSE, JOINTS) for k in range(MOST_POSES)}
    saved = saved._with(full)
    saved.with_pose('p1', SavedPose(POSE, JOINTS))
    with pytest.raises(InvalidInput, match='300 poses are saved already'):
        saved.with_pose('more', SavedPose(POSE, JOINTS))


def test_everything_wrong_with_a_file_is_reported_at_once(empty):
    text = """\
poses:
  1: {xyz_mm: [0, 0, 0], rpy_deg: [0, 0, 0], joints_deg: [0, 0, 0, 0, 0, 0]}
  short: {xyz_mm: [0, 0], rpy_deg: [0, 0, 0], joints_deg: [0, 0, 0]}
  metres: {xyz_mm: [0, 0, 0], rpy_deg: [0, 0, 0], joints_mm: [0, 0, 0, 0, 0, 0]}
  five: {xyz_mm: [0, 0, 0], rpy_deg: [0, 0, 0], joints_deg: [0, 0, 0, 0, 0]}
sequences:
  wave: [nowhere]
  none: []
  fast: [{pose: metres, speed_mm_s: -1}]
"""
    with pytest.raises(ConfigError) as caught:
        empty.read(text)
    problems = '\n'.join(caught.value.problems)
    for words in (
        'poses.1: 1 is not a name',
        'poses.short: xyz_mm: has 2 entries, needs 3',
        'poses.metres: the joints need the key joints_deg',
        'poses.five: joints_deg: needs 6 numbers',
        "sequences.wave: [0].pose: no saved pose is called 'nowhere'",
        'sequences.none: needs a list of 1 to 1000 steps',
        'sequences.fast: [0].speed_mm_s: -1 outside',
    ):
        assert words in problems
