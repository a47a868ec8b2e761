"""All branches of arms without a closed form: parallel axes, axes that meet, and neither."""

from dataclasses import replace

import numpy as np
import pytest

from arm_control.arm import SerialArm
from arm_control.chain import Chain
from arm_control.load import serial_arm
from arm_control.numerical import NO_LOOP, Numerical
from branches import apart
from hexarm.machines import load
from sampling import enough

OFFSETS = {
    'wrist axes pass each other by 10 mm': [(4, 'a_mm', 10.0)],
    'axis 5 passes axis 4 by 60 mm': [(3, 'a_mm', 60.0)],
    'wrist 100 mm long between axes 4 and 6': [(4, 'd_mm', 100.0)],
    'no offset but between axes 4 and 6': [(2, 'a_mm', 0.0), (2, 'd_mm', 0.0), (4, 'd_mm', 150.0)],
    'forearm twisted by 20 degrees': [(1, 'alpha_deg', 20.0)],
}


@pytest.fixture(params=[*OFFSETS, 'every axis askew'])
def arm(request, machine_file):
    """A PUMA that was built otherwise."""
    file = machine_file('puma560')
    if request.param in OFFSETS:
        return built(file, OFFSETS[request.param])
    puma, rng = serial_arm(file), np.random.default_rng(7)
    axes = puma.chain.axes + rng.uniform(-0.2, 0.2, (6, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    chain = Chain(axes, puma.chain.points, puma.chain.home)
    return SerialArm(chain, puma.limits, puma.characteristic_length, puma.rest)


def built(file, changes):
    rows = [dict(row) for row in file.geometry['dh']]
    for row, key, value in changes:
        rows[row][key] = value
    return serial_arm(replace(file, geometry={**file.geometry, 'dh': rows}))


def some_joints(count):
    return np.random.default_rng(4).uniform(-np.pi, np.pi, (count, 6))


def test_the_joints_that_made_a_pose_are_among_its_branches(arm):
    assert isinstance(arm.method, Numerical)
    assert arm.method.loops[0] != NO_LOOP
    assert misses(arm, enough(1000, 20_000)) == 0


@pytest.mark.parametrize('name', ['xarm6', 'niryo_one'])
def test_no_posture_of_a_shipped_arm_is_missed(name):
    assert misses(load(name).kinematics, enough(2000, 100_000)) == 0


def misses(arm, count):
    """How many of the postures are not among the branches of their pose."""
    joints = some_joints(count)
    branches = arm.method.branches(arm.chain.forward(joints), np.zeros(6))
    return (apart(branches, joints[:, None]).min(axis=-1) > 1e-4).sum()


def test_every_branch_leads_to_the_pose_and_none_stands_twice(arm):
    poses = arm.chain.forward(some_joints(50))
    for k, branches in enumerate(arm.method.branches(poses, np.zeros(6))):
        found = branches[np.isfinite(branches[:, 0])]
        assert 2 <= len(found) <= 16
        assert len(found) % 2 == 0 or arm.sigma_min(poses[k], found).min() < 0.02
        for i, one in enumerate(found):
            assert np.abs(arm.chain.forward(one).twist_to(poses[k])).max() < 1e-9
            assert (apart(np.delete(found, i, axis=0), one) > 1e-6).all()


def test_the_branch_nearest_to_given_joints_is_taken(arm):
    joints = some_joints(100).clip(arm.limits.low + 0.1, arm.limits.high - 0.1)
    near = joints + np.random.default_rng(5).uniform(-0.05, 0.05, joints.shape)
    found = arm.inverse(arm.chain.forward(joints), near)
    regular = arm.sigma_min(arm.home, joints) > 0.1
    assert regular.sum() > 40
    assert np.abs(found - joints)[regular].max() < 1e-7


def test_branches_of_an_arm_without_shoulder_and_elbow_offset_have_mirror_images(machine_file):
    arm = built(machine_file('puma560'), OFFSETS['no offset but between axes 4 and 6'])
    poses = arm.chain.forward(some_joints(200))
    for branches in arm.method.branches(poses, np.zeros(6)):
        found = branches[np.isfinite(branches[:, 0])]
        images = np.pi * np.array([1, 1, -1, 1, 0, 0]) + found * [1, -1, -1, 1, 1, 1]
        assert apart(images[:, None], found).min(axis=1).max() < 1e-5


def test_beside_a_fold_the_nearest_branch_is_taken():
    arm = load('xarm6').kinematics
    rng = np.random.default_rng(11)
    near = rng.uniform(arm.limits.low + 0.1, arm.limits.high - 0.1, (10_000, 6))
    poses = arm.chain.forward(near + rng.uniform(-0.01, 0.01, near.shape))
    folds = np.argsort(arm.sigma_min(poses, near))[:1000]
    near, poses = near[folds], poses[folds]
    off = arm.method.branches(poses, near) - near[:, None]
    least = np.nanmin(np.linalg.norm((off + np.pi) % (2 * np.pi) - np.pi, axis=-1), axis=1)
    assert (np.linalg.norm(arm.inverse(poses, near) - near, axis=1) < least + 1e-6).all()


def test_a_place_beyond_all_links_has_no_branch(arm):
    far = replace(arm.home, position=np.array([9.0, 0.0, 0.0]))
    assert np.isnan(arm.inverse_all(far)).all()
