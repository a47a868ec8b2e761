import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from manipulator.errors import InvalidInput
from manipulator.pose import Pose

numbers = st.floats(-10, 10)
poses = st.builds(
    Pose.from_xyz_rpy,
    st.tuples(numbers, numbers, numbers),
    st.tuples(numbers, numbers, numbers),
)


def homogeneous(pose):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose.rotation, pose.position
    return matrix


@given(poses, poses)
def test_composition_is_the_product_of_homogeneous_matrices(a, b):
    np.testing.assert_allclose(
        homogeneous(a @ b), homogeneous(a) @ homogeneous(b), rtol=0, atol=1e-12
    )


@given(poses)
def test_a_pose_and_its_inverse_cancel(pose):
    np.testing.assert_allclose(homogeneous(pose @ pose.inverse()), np.eye(4), atol=1e-12)


@given(poses, poses)
def test_the_twist_to_a_target_arrives_there(start, target):
    arrived = start.moved(start.twist_to(target))
    np.testing.assert_allclose(homogeneous(arrived), homogeneous(target), atol=1e-8)


@given(poses)
def test_points_are_mapped_as_by_the_homogeneous_matrix(pose):
    points = np.array([[1.0, 2.0, 3.0], [-1.0, 0.5, 0.0]])
    expected = (homogeneous(pose) @ np.c_[points, np.ones(2)].T).T[:, :3]
    np.testing.assert_allclose(pose.transform(points), expected, atol=1e-12)


@given(poses)
def test_quaternion_and_angles_describe_the_same_rotation(pose):
    by_quaternion = Pose.from_xyz_quaternion(pose.position, pose.quaternion)
    by_angles = Pose.from_xyz_rpy(pose.position, pose.rpy)
    np.testing.assert_allclose(homogeneous(by_quaternion), homogeneous(pose), atol=1e-12)
    np.testing.assert_allclose(homogeneous(by_angles), homogeneous(pose), atol=1e-7)


def test_arrays_of_poses_do_what_single_poses_do():
    generator = np.random.default_rng(0)
    a, b = (
        Pose.from_xyz_rpy(generator.normal(size=(4, 3)), generator.normal(size=(4, 3)))
        for _ in range(2)
    )
    single = [a[k] @ b[k].inverse() for k in range(4)]
    together = a @ b.inverse()
    for k in range(4):
        np.testing.assert_allclose(homogeneous(together[k]), homogeneous(single[k]), atol=1e-14)


def test_one_rotation_serves_many_positions():
    poses = Pose.from_xyz_rpy(np.zeros((5, 3)), [0.1, 0.2, 0.3])
    assert poses.rotation.shape == (5, 3, 3)
    np.testing.assert_array_equal(poses[4].rotation, poses[0].rotation)


def test_arrays_are_copies_that_cannot_be_written():
    position = np.zeros(3)
    pose = Pose(position, np.eye(3))
    position[0] = 1.0
    assert pose.position[0] == 0.0
    for array in (pose.position, pose.rotation, Pose.unchecked(np.zeros(3), np.eye(3)).position):
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 1.0


@pytest.mark.parametrize(
    ('position', 'rotation', 'message'),
    [
        ([0, 0], np.eye(3), 'position has shape'),
        ([0, 0, 0], np.eye(2), 'rotation has shape'),
        (np.zeros((2, 3)), np.tile(np.eye(3), (3, 1, 1)), 'does not fit'),
        ([0, np.nan, 0], np.eye(3), 'position is not finite'),
        ([0, 0, 0], np.full((3, 3), np.inf), 'rotation is not finite'),
    ],
)
def test_what_is_no_pose_is_refused(position, rotation, message):
    with pytest.raises(InvalidInput, match=message):
        Pose(np.asarray(position, dtype=float), rotation)


@given(poses)
def test_a_printed_pose_makes_the_pose_again(pose):
    again = eval(repr(pose), {'Pose': Pose})
    np.testing.assert_allclose(homogeneous(again), homogeneous(pose), atol=2e-6)


def test_a_pose_is_printed_in_numbers_that_a_person_reads():
    pose = Pose.from_xyz_rpy([0.004, -1e-18, 0.045], [0.0, 0.05, 0.0])
    assert repr(pose) == 'Pose.from_xyz_rpy([0.004, 0.0, 0.045], [0.0, 0.05, 0.0])'


def test_an_array_of_poses_is_printed_as_its_shape():
    assert repr(Pose.from_xyz_rpy(np.zeros((20, 3)))) == '<Pose of shape (20,)>'
