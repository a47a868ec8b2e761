import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_control.arm import SerialArm
from arm_control.chain import Chain
from arm_control.load import serial_arm
from arm_control.numerical import Numerical
from branches import apart
from manipulator.errors import InvalidInput, NoSolution, Unreachable
from manipulator.pose import Pose


def within_range(arm, count, seed):
    return np.random.default_rng(seed).uniform(arm.limits.low, arm.limits.high, (count, 6))


def test_every_branch_takes_the_tool_to_the_pose(arm):
    poses = arm.chain.forward(within_range(arm, 300, 1))
    branches = arm.inverse_all(poses)
    assert branches.shape == (300, 8, 6)
    closes = ~np.isnan(branches).any(axis=-1)
    reached = arm.chain.forward(np.nan_to_num(branches))
    targets = Pose(poses.position[:, None], poses.rotation[:, None])
    assert np.abs(reached.twist_to(targets)[closes]).max() < 1e-9


def test_the_joints_that_made_the_pose_are_among_the_branches(arm):
    joints = within_range(arm, 300, 2)
    branches = arm.inverse_all(arm.chain.forward(joints))
    assert apart(branches, joints[:, None]).min(axis=-1).max() < 1e-6


def test_branches_differ(arm):
    poses = arm.chain.forward(within_range(arm, 100, 3))
    for branches in arm.inverse_all(poses):
        closing = branches[~np.isnan(branches).any(axis=-1)]
        for i, one in enumerate(closing):
            assert all(apart(one, other) > 1e-6 for other in closing[:i])


def test_inverse_stays_with_the_joints_it_is_near_to(arm):
    joints = within_range(arm, 300, 4)
    nudge = np.random.default_rng(5).uniform(-0.01, 0.01, (300, 6))
    found = arm.inverse(arm.chain.forward(joints), joints + nudge)
    regular = arm.sigma_min(arm.home, joints) > 0.02
    assert regular.sum() > 200
    assert np.abs(found - joints)[regular].max() < 1e-7


def test_a_row_of_poses_stays_on_a_branch_however_far_the_joints_before_it_are(arm):
    joints = within_range(arm, 200, 6)
    away = np.random.default_rng(7).uniform(-0.5, 0.5, (200, 6))
    poses = arm.chain.forward(joints)
    for position, rotation, near in zip(
        poses.position, poses.rotation, joints + away, strict=True
    ):
        row = Pose(np.tile(position, (3, 1)), np.tile(rotation, (3, 1, 1)))
        found = arm.inverse_along(row, near)
        assert np.abs(found - found[0]).max() < 1e-7


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1), st.sets(st.integers(0, 5)))
def test_singular_postures_are_inverted_exactly_too(arm, seed, zeroed):
    joints = within_range(arm, 1, seed)[0]
    joints[list(zeroed)] = 0.0
    pose = arm.chain.forward(joints)
    found = arm.inverse(pose, joints)
    assert np.abs(arm.chain.forward(found).twist_to(pose)).max() < 1e-7


@pytest.mark.parametrize(
    'joints',
    [[0.3, 0.4, 1.0, 0.8, 0.0, -0.5], [0.3, -0.5, 1.0, 0.8, 0.7, -0.5]],
    ids=['wrist aligned', 'wrist above joint 1'],
)
def test_joints_that_the_pose_leaves_free_stay_as_they_were(arm_6r, joints):
    found = arm_6r.inverse(arm_6r.chain.forward(np.array(joints)), np.array(joints))
    assert np.abs(found - joints).max() < 1e-9


def test_a_wrist_nearly_aligned_is_inverted_exactly(arm):
    for offset in np.geomspace(1e-10, 1e-3, 40):
        joints = arm.rest + np.radians([5.0, 3.0, -4.0, 6.0, 0.0, 7.0])
        joints[4] = offset
        pose = arm.chain.forward(joints)
        found = arm.inverse(pose, joints)
        assert np.abs(arm.chain.forward(found).twist_to(pose)).max() < 1e-9


def test_whole_turns_are_chosen_near_but_within_the_range(arm_6r):
    joints = np.radians([10.0, 20.0, 80.0, 30.0, 60.0, 300.0])
    pose = arm_6r.chain.forward(joints)
    assert np.degrees(arm_6r.inverse(pose, joints)[5]) == pytest.approx(300.0)
    assert np.degrees(arm_6r.inverse(pose, joints * (1, 1, 1, 1, 1, 0))[5]) == pytest.approx(-60.0)
    beyond = joints + np.radians([0, 0, 0, 0, 0, 70.0])
    last = np.degrees(arm_6r.inverse_all(arm_6r.chain.forward(beyond), beyond)[:, 5])
    assert {10.0, 190.0} <= set(last.round(6))
    assert (np.abs(last) <= 350.0).all()


@pytest.mark.parametrize('side', [1, -1])
def test_an_angle_beyond_either_end_of_its_range_comes_back_by_a_whole_turn(arm_6r, side):
    beyond = np.radians([10.0, 20.0, 80.0, 30.0, 60.0, side * 460.0])
    last = np.degrees(arm_6r.inverse_all(arm_6r.chain.forward(beyond), beyond)[:, 5])
    assert {side * 100.0, side * 280.0} <= set(last.round(6))


def test_branches_within_the_joint_ranges_come_before_nearer_ones(arm_6r):
    inside = np.radians([10.0, 20.0, 80.0, 30.0, 60.0, 0.0])
    pose = arm_6r.chain.forward(inside)
    branches = arm_6r.inverse_all(pose, inside)
    outside = (branches < arm_6r.limits.low) | (branches > arm_6r.limits.high)
    assert outside.any()
    start = branches[outside.any(axis=-1)][0].clip(arm_6r.limits.low, arm_6r.limits.high)
    found = arm_6r.inverse(pose, start)
    assert (found >= arm_6r.limits.low).all()
    assert (found <= arm_6r.limits.high).all()


def test_an_arm_that_stands_beyond_its_range_stays_on_its_branch(arm_6r):
    beyond = np.radians([10.0, 20.0, 80.0, 30.0, 121.5, 0.0])
    assert beyond[4] > arm_6r.limits.high[4]
    found = arm_6r.inverse(arm_6r.chain.forward(beyond), beyond)
    assert np.abs(found - beyond).max() < 1e-9
    further_in = arm_6r.inverse(arm_6r.chain.forward(beyond - [0, 0, 0, 0, 0.01, 0]), beyond)
    assert np.abs(further_in - beyond).max() < 0.011


def test_a_straight_path_stays_on_one_branch(arm):
    start = arm.home
    joints = arm.rest
    for k in range(100):
        pose = Pose(start.position + k * np.array([1e-3, 5e-4, 1e-3]), start.rotation)
        following = arm.inverse(pose, joints)
        assert np.abs(following - joints).max() < 0.05
        joints = following


@pytest.mark.parametrize(
    ('position', 'reason'),
    [
        ([1.0, 0.0, 0.42], 'wrist centre 1 m from the shoulder, reach is 0.8 m'),
        ([0.0, 1.2, 0.42], 'wrist centre 1.2 m from the shoulder, reach is 0.8 m'),
    ],
)
def test_out_of_reach_says_what_and_by_how_much(arm_6r, position, reason):
    with pytest.raises(Unreachable, match=reason):
        arm_6r.inverse(Pose(position, np.eye(3)))


@pytest.mark.parametrize('name', ['ur5', 'puma560'])
def test_too_near_to_an_offset_shoulder_is_named(machine_file, name):
    arm = serial_arm(machine_file(name))
    tool = arm.chain.home.rotation.T @ (arm.chain.home.position - arm.chain.points[5])
    pose = Pose(np.array([0.01, 0.0, 0.5]) + tool, np.eye(3))
    with pytest.raises(Unreachable, match=r"0\.01 m from joint 1's axis, needs at least"):
        arm.inverse(pose)


def test_the_refusal_is_about_the_branch_that_comes_nearest(machine_file):
    arm = serial_arm(machine_file('ur5'))
    stretched = arm.chain.forward(np.radians([0.0, 0.0, 0.0, -30.0, -10.0, 0.0]))
    outward = stretched.moved([-0.05, 0, 0, 0, 0, 0])
    with pytest.raises(Unreachable) as caught:
        arm.inverse(outward)
    wanted, reach = map(float, re.findall(r'(0\.\d+) m', str(caught.value)))
    assert reach == pytest.approx(0.425 + 0.39225, abs=1e-4)
    assert 0 < wanted - reach <= 0.05


def test_arrays_mark_or_name_what_is_out_of_reach(arm):
    near, far = arm.home.position, np.array([5.0, 0.0, 0.0])
    poses = Pose(np.stack([near, far, near]), np.stack([arm.home.rotation] * 3))
    lost = np.isnan(arm.inverse_or_nan(poses)).all(axis=-1)
    assert lost.tolist() == [False, True, False]
    with pytest.raises(Unreachable, match=r'pose \[1\]: .* m from the shoulder'):
        arm.inverse(poses)


def test_joints_that_are_no_six_finite_numbers_are_refused(arm_6r):
    for joints in (np.zeros(5), np.full(6, np.nan)):
        with pytest.raises(NoSolution):
            arm_6r.forward(joints)
        with pytest.raises(InvalidInput):
            arm_6r.inverse(arm_6r.home, joints)


@pytest.fixture(scope='module')
def bent_arm(machine_file):
    """An arm without any closed form: every axis of the paper's arm a little off."""
    straight = serial_arm(machine_file('arm_6r'))
    rng = np.random.default_rng(7)
    axes = straight.chain.axes + rng.uniform(-0.1, 0.1, (6, 3))
    chain = Chain(
        axes / np.linalg.norm(axes, axis=1, keepdims=True),
        straight.chain.points + rng.uniform(-0.02, 0.02, (6, 3)),
        straight.chain.home,
    )
    return SerialArm(chain, straight.limits, straight.characteristic_length, straight.rest)


def test_an_arm_without_closed_form_is_solved_numerically(bent_arm):
    assert isinstance(bent_arm.method, Numerical)
    joints = within_range(bent_arm, 40, 8)
    poses = bent_arm.chain.forward(joints)
    found = bent_arm.inverse_or_nan(poses)
    reached = ~np.isnan(found).any(axis=-1)
    assert reached.mean() == 1.0
    assert np.abs(bent_arm.chain.forward(found).twist_to(poses)).max() < 1e-9


def test_the_numerical_inverse_stays_near(bent_arm):
    joints = within_range(bent_arm, 40, 9)
    joints = joints[bent_arm.sigma_min(bent_arm.home, joints) > 0.05]
    nudge = np.random.default_rng(10).uniform(-0.02, 0.02, joints.shape)
    found = bent_arm.inverse(bent_arm.chain.forward(joints), joints + nudge)
    assert np.abs(found - joints).max() < 1e-8


def test_the_numerical_inverse_follows_a_path(bent_arm):
    joints = bent_arm.rest + np.linspace(0.0, 0.2, 30)[:, None] * [1.0, -0.5, 0.5, 1.0, 0.5, -1.0]
    found = bent_arm.inverse_along(bent_arm.chain.forward(joints), joints[0])
    assert np.abs(found - joints).max() < 1e-8


def test_the_numerical_inverse_says_by_how_much_it_missed(bent_arm):
    with pytest.raises(Unreachable, match=r'best of 33 starts missed by .* m and'):
        bent_arm.inverse(replace(bent_arm.home, position=[3.0, 0.0, 0.0]))
