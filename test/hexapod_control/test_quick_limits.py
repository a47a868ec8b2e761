"""What limits admit by sines, cosines and pivots, against their values."""

import dataclasses

import numpy as np
import pytest

from hexapod_control.leg_limits import singularity_margin
from hexarm.machines import load
from manipulator.limits.constraints import Constraints
from manipulator.pose import Pose


@pytest.fixture(scope='module', params=['robocake', 'stewart_6_3', 'stewart_6_6'])
def cloud(request):
    """A machine, and poses of which each limit admits some and refuses some; some do not close."""
    machine = load(request.param)
    length = machine.kinematics.characteristic_length
    generator = np.random.default_rng(1)
    steps = generator.standard_normal((20_000, 6)) * generator.uniform(0, 0.8, (20_000, 1))
    poses = machine.kinematics.home.moved(steps * ([length] * 3 + [1.0] * 3))
    return machine, poses, machine.kinematics.inverse_or_nan(poses)


def halved(limit):
    """Swings and tilts, of which few are as large as allowed, are made stricter."""
    if limit.quantity.split()[-1] not in ('swing', 'tilt'):
        return limit
    return dataclasses.replace(limit, low=0.5 * limit.low, high=0.5 * limit.high)


def by_values(limit, poses, joints):
    values = limit.values(poses, joints)
    return ((values >= limit.low) & (values <= limit.high)).all(axis=-1)


def test_many_poses_are_admitted_as_their_values_say(cloud):
    machine, poses, joints = cloud
    closed = np.isfinite(joints).all(axis=1)
    for limit in map(halved, machine.constraints.limits):
        expected = by_values(limit, poses, joints)[closed]
        np.testing.assert_array_equal(
            Constraints((limit,)).admits(poses, joints)[closed], expected
        )
        if not limit.quantity.startswith('rod'):
            assert 0 < expected.sum() < closed.sum()
    assert not machine.constraints.admits(poses, joints)[~closed].any()


def test_single_poses_are_admitted_as_the_many_are(cloud):
    machine, poses, joints = cloud
    everything = machine.constraints.admits(poses, joints)
    for k in range(0, 20_000, 200):
        if np.isfinite(joints[k]).all():
            assert machine.constraints.admits(poses[k], joints[k]) == everything[k]


def test_the_margin_test_is_sharp(cloud):
    """Just below and just above σmin itself, where pivots tell the two apart."""
    machine, poses, joints = cloud
    kinematics = machine.kinematics
    closed = np.flatnonzero(np.isfinite(joints).all(axis=1))[:300]
    sigma = kinematics.sigma_min(poses[closed], joints[closed])
    for k in closed[sigma > 1e-3][:60]:
        least = float(kinematics.sigma_min(poses[k], joints[k]))
        for factor, is_kept in ((1 - 1e-6, True), (1 + 1e-6, False)):
            limits = Constraints((singularity_margin(kinematics, least * factor),))
            assert limits.admits(poses[k], joints[k]) == is_kept


def test_the_margin_test_is_sharp_beside_a_singular_pose():
    """On the way down, where σmin is so small that pivots tell nothing."""
    kinematics = load('robocake').kinematics

    def sigma(height):
        pose = Pose.from_xyz_rpy([0.0, 0.0, height])
        joints = kinematics.inverse(pose)
        side = np.linalg.det(kinematics.leg_jacobian(pose, joints)) * kinematics.home_side
        return float(np.copysign(kinematics.sigma_min(pose, joints), side)), pose, joints

    low, high = 0.005, 0.030
    while sigma(high)[0] > 1e-6:
        middle = (low + high) / 2
        low, high = (low, middle) if sigma(middle)[0] > 0.0 else (middle, high)
    least, pose, joints = sigma(high)
    for factor, is_kept in ((0.99, True), (1.01, False)):
        limits = Constraints((singularity_margin(kinematics, least * factor),))
        assert limits.admits(pose, joints) == is_kept
