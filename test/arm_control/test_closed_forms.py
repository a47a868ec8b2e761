"""Closed forms of other arms than the shipped ones, and in postures that leave joints free."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from arm_control.arm import SerialArm
from arm_control.chain import Chain
from arm_control.load import serial_arm
from branches import apart
from manipulator.pose import Pose

SENSES = [(a, b, c) for a, b, c in product([1.0, -1.0], repeat=3) if (a, b, c) != (1, 1, 1)]


def with_turned_axes(arm, senses):
    """The same arm, whose joints 2, 3 and 4 count their angles in these senses; and all six."""
    signs = np.array([1.0, *senses, 1.0, 1.0])
    chain = Chain(arm.chain.axes * signs[:, None], arm.chain.points, arm.chain.home)
    ends = np.array([arm.limits.low, arm.limits.high]) * signs
    limits = replace(arm.limits, low=ends.min(axis=0), high=ends.max(axis=0))
    return SerialArm(chain, limits, arm.characteristic_length, arm.rest * signs), signs


@pytest.mark.parametrize('senses', SENSES)
def test_axes_of_opposite_senses_make_the_same_arm_with_angles_of_opposite_signs(arm, senses):
    turned, signs = with_turned_axes(arm, senses)
    assert type(turned.method) is type(arm.method)
    joints = np.random.default_rng(12).uniform(arm.limits.low, arm.limits.high, (30, 6))
    poses = arm.chain.forward(joints)
    branches = turned.inverse_all(poses)
    assert apart(branches, (signs * joints)[:, None]).min(axis=-1).max() < 1e-6
    closes = ~np.isnan(branches).any(axis=-1)
    reached = turned.chain.forward(np.nan_to_num(branches))
    targets = Pose(poses.position[:, None], poses.rotation[:, None])
    assert np.abs(reached.twist_to(targets)[closes]).max() < 1e-9


def test_an_arm_whose_shoulder_is_ahead_of_joint_1_is_inverted_too(arm):
    chain = arm.chain
    ahead = 0.1 * np.cross(chain.axes[0], chain.axes[1])
    points = chain.points + np.outer([0, 1, 1, 1, 1, 1], ahead)
    home = Pose(chain.home.position + ahead, chain.home.rotation)
    shifted = SerialArm(
        Chain(chain.axes, points, home), arm.limits, arm.characteristic_length, arm.rest
    )
    assert type(shifted.method) is type(arm.method)
    joints = np.random.default_rng(13).uniform(arm.limits.low, arm.limits.high, (30, 6))
    branches = shifted.inverse_all(shifted.chain.forward(joints))
    assert apart(branches, joints[:, None]).min(axis=-1).max() < 1e-6


@pytest.mark.parametrize(
    ('name', 'joints', 'free'),
    [
        ('arm_6r', [0.3, 0.4, 1.0, 0.8, 0.0, -0.5], 4),  # wrist aligned
        ('arm_6r', [0.3, -0.5, 1.0, 0.8, 0.7, -0.5], 1),  # wrist above joint 1
        ('puma560', [0.3, 0.4, 1.0, 0.8, 0.0, -0.5], 4),
        ('ur5', [0.3, -1.0, 1.2, 0.8, 0.0, -0.5], 6),  # axis 6 parallel to axes 2 to 4
    ],
)
@pytest.mark.parametrize('offset', [0.2, -0.9])
def test_a_joint_that_the_pose_leaves_free_is_where_the_near_one_is(
    machine_file, name, joints, free, offset
):
    arm, near = serial_arm(machine_file(name)), np.array(joints)
    pose = arm.chain.forward(near)
    near[free - 1] += offset
    found = arm.inverse(pose, near)
    assert np.abs(arm.chain.forward(found).twist_to(pose)).max() < 1e-9
    assert found[free - 1] == pytest.approx(near[free - 1], abs=1e-9)
