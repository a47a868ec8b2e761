"""What the library in C is given: whatever shape arrays come in, and what is refused."""

import numpy as np
import pytest

from arm_control.numerical import Numerical
from manipulator import _kernel
from manipulator.errors import InvalidInput, NoSolution, Unreachable
from manipulator.pose import Pose


@pytest.fixture(scope='module', params=['closed', 'numerical'])
def method(request, arm_6r):
    if request.param == 'closed':
        return arm_6r.method
    limits = arm_6r.limits
    return Numerical(arm_6r.chain, arm_6r.characteristic_length, limits.low, limits.high)


def test_arrays_in_any_order_of_memory_give_what_contiguous_ones_give(arm):
    joints = np.random.default_rng(1).uniform(-1, 1, (5, 6))
    spread = np.asfortranarray(joints)
    poses = arm.chain.forward(joints)
    turned = Pose(np.asfortranarray(poses.position), np.asfortranarray(poses.rotation))
    assert not spread.flags.c_contiguous
    assert np.array_equal(arm.chain.forward(spread).position, poses.position)
    assert np.array_equal(arm.chain.jacobian(spread), arm.chain.jacobian(joints))
    assert np.array_equal(arm.sigma_min(poses, spread), arm.sigma_min(poses, joints))
    assert np.array_equal(arm.inverse(turned, spread), arm.inverse(poses, joints))
    one, all_of_them = arm.inverse_all(turned[1], spread[1]), arm.inverse_all(poses, joints)
    assert np.array_equal(one, all_of_them[1], equal_nan=True)


def test_integers_lists_read_only_and_misaligned_arrays_are_joints_too(arm):
    zeros = np.zeros(6)
    zeros.flags.writeable = False
    misaligned = np.frombuffer(bytes(49), offset=1)
    singles, integers = np.zeros(6, dtype=np.float32), np.zeros(6, dtype=np.int64)
    for joints in (integers, [0] * 6, singles, zeros, misaligned):
        assert np.array_equal(arm.forward(joints).pose.position, arm.chain.home.position)
        assert np.array_equal(arm.jacobian(arm.home, joints), arm.chain.jacobian(np.zeros(6)))
        assert np.isfinite(arm.inverse(arm.home, joints)).all()


def test_no_poses_have_no_joints(arm):
    none = Pose(np.empty((0, 3)), np.empty((0, 3, 3)))
    assert arm.inverse(none).shape == (0, 6)
    assert arm.inverse_or_nan(none, np.empty((0, 6))).shape == (0, 6)
    assert arm.inverse_all(none).shape == (0, 8, 6)
    assert arm.inverse_along(none, arm.rest).shape == (0, 6)
    assert arm.chain.forward(np.empty((0, 6))).position.shape == (0, 3)
    assert arm.jacobian(none, np.empty((0, 6))).shape == (0, 6, 6)
    assert arm.sigma_min(none, np.empty((0, 6))).shape == (0,)


def test_one_pose_near_many_joints_and_many_near_one(arm):
    joints = np.random.default_rng(2).uniform(-1, 1, (2, 3, 6))
    poses = arm.chain.forward(joints)
    assert np.array_equal(
        arm.inverse(poses[0, 1], joints)[1, 2], arm.inverse(poses[0, 1], joints[1, 2])
    )
    assert np.array_equal(
        arm.inverse(poses, joints[0, 0])[1, 2], arm.inverse(poses[1, 2], joints[0, 0])
    )


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf])
def test_joints_that_are_not_finite_are_refused_in_the_same_words_everywhere(arm, bad):
    joints = np.zeros(6)
    joints[3] = bad
    for ask in (arm.inverse, arm.inverse_or_nan, arm.inverse_all):
        with pytest.raises(InvalidInput, match='joints are not finite'):
            ask(arm.home, joints)
    with pytest.raises(InvalidInput, match='joints are not finite'):
        arm.inverse_along(Pose(arm.home.position[None], arm.home.rotation[None]), joints)
    with pytest.raises(InvalidInput, match='joints are not finite'):
        arm.jacobian(arm.home, joints)
    with pytest.raises(InvalidInput, match='position is not finite'):
        arm.chain.forward(joints)
    with pytest.raises(NoSolution, match='not six finite angles'):
        arm.forward(joints)
    assert np.isnan(arm.sigma_min(arm.home, joints))


@pytest.mark.parametrize('shape', [(5,), (7,), (2, 5), (6, 1), ()])
def test_joints_of_another_shape_are_refused(arm, shape):
    joints = np.zeros(shape)
    for ask in (arm.inverse, arm.inverse_or_nan, arm.inverse_all, arm.jacobian, arm.sigma_min):
        with pytest.raises(InvalidInput, match=r'needs \(..., 6\)'):
            ask(arm.home, joints)
    for ask in (arm.chain.forward, arm.chain.jacobian, arm.chain.displacements):
        with pytest.raises(ValueError, match='needs'):
            ask(joints)


def test_arrays_that_do_not_fit_never_reach_the_mathematics(arm_6r):
    chain = arm_6r.chain.numbers
    joints, jacobian = np.zeros(6), np.empty((6, 6))
    frozen = jacobian.copy()
    frozen.flags.writeable = False
    for arrays in (
        (chain[:-1], joints, jacobian),
        (chain, joints[:5], jacobian),
        (chain, joints, jacobian[:5]),
        (chain, joints, frozen),
        (chain, joints, jacobian.T[:, ::2]),
        (chain, joints, np.empty((2, 6, 6))),
    ):
        with pytest.raises(ValueError):
            _kernel.chain_jacobian(*arrays)
    for arrays in (
        (chain, joints.astype(int), jacobian),
        (chain, joints.astype('>f8'), jacobian),
        (chain, joints),
        (chain, joints, None),
    ):
        with pytest.raises(TypeError):
            _kernel.chain_jacobian(*arrays)


def test_a_pose_that_is_no_rotation_has_no_joints_and_does_no_harm(method):
    """Pose refuses NaN; what is not orthonormal may be solved or not."""
    for rotation in (np.zeros((3, 3)), 1e300 * np.eye(3), -np.eye(3), np.full((3, 3), 1e-300)):
        branches = method.branches(Pose(np.array([0.3, 0.1, 0.5]), rotation), np.zeros(6))
        assert branches.shape[-1] == 6


def test_poses_at_the_end_of_the_numbers_are_out_of_reach(arm):
    for size in (1e9, 1e154, 1e300):
        far = Pose(np.array([size, -size, size]), np.eye(3))
        assert np.isnan(arm.inverse_or_nan(far)).all()
        with pytest.raises(Unreachable):
            arm.inverse(far)
