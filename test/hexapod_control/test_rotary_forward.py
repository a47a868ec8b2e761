"""Forward kinematics of the crank hexapod: right, or refused."""

import numpy as np
import pytest

from manipulator.errors import NoSolution
from manipulator.pose import Pose


def rolled(roll):
    return Pose.from_xyz_rpy([0.0, 0.0, 0.04119], [roll, 0.0, 0.0])


def test_forward_from_home_returns_the_pose_in_six_iterations(hexapod, many):
    joints = hexapod.inverse(many)
    solutions = [hexapod.forward(q) for q in joints]
    assert max(s.iterations for s in solutions) <= 6
    found = Pose(
        np.stack([s.pose.position for s in solutions]),
        np.stack([s.pose.rotation for s in solutions]),
    )
    error = np.abs(many.twist_to(found))
    assert error[:, :3].max() < 1e-9
    assert error[:, 3:].max() < 1e-8


def test_cold_start_refuses_what_lies_below_the_trusted_margin(hexapod):
    pose = rolled(0.345)
    joints = hexapod.inverse(pose)
    assert hexapod.sigma_min(pose, joints) < 0.3
    with pytest.raises(NoSolution, match='margin'):
        hexapod.forward(joints)
    warm = hexapod.forward(joints, rolled(0.344))
    assert np.abs(pose.twist_to(warm.pose)).max() < 1e-8


def test_cranks_that_no_platform_joins_are_refused(hexapod):
    joints = np.radians([30.0, 210.0, 30.0, 210.0, 120.0, 60.0])
    with pytest.raises(NoSolution):
        hexapod.forward(joints)


def test_cold_answers_outside_are_right_refused_or_have_a_twin_inside(robocake, hexapod):
    """Where no rule can tell, the same six angles belong to a pose inside the limits as well."""
    generator = np.random.default_rng(6)
    xyz = generator.uniform([-0.02, -0.02, 0.02339], [0.02, 0.02, 0.06], (40_000, 3))
    poses = Pose.from_xyz_rpy(xyz, generator.uniform(-0.25, 0.25, (40_000, 3)))
    joints = hexapod.inverse_or_nan(poses)
    closed = np.flatnonzero(np.isfinite(joints).all(axis=1))
    outside = closed[~robocake.constraints.admits(poses[closed], joints[closed])]
    assert len(outside) > 200
    refused = right = twins = 0
    for k in outside:
        try:
            found = hexapod.forward(joints[k]).pose
        except NoSolution:
            refused += 1
            continue
        if np.abs(poses[k].twist_to(found)).max() < 1e-6:
            right += 1
        elif robocake.constraints.admits(found, joints[k]):
            side = np.linalg.det(hexapod.leg_jacobian(poses[k], joints[k]))
            assert side * hexapod.home_side < 0
            twins += 1
        # What is left is a wrong pose beyond a limit, where Constraints speak up.
    assert refused > 0
    assert right > 0
    assert twins <= 0.25 * len(outside)


def test_a_warm_start_follows_a_pose_that_a_cold_start_takes_for_its_twin(hexapod):
    # Below the lid and beyond the singularity; its angles fit a pose inside as well.
    pose = Pose.from_xyz_rpy([0.0, 0.0, 0.005])
    joints = hexapod.inverse(pose)
    start = pose.moved([0.0003, 0.0, 0.0003, 0.0, 0.005, 0.0])
    assert np.abs(pose.twist_to(hexapod.forward(joints, start).pose)).max() < 1e-9
    assert np.linalg.det(hexapod.leg_jacobian(pose, joints)) * hexapod.home_side < 0
    try:
        assert hexapod.forward(joints).pose.position[2] > 0.015
    except NoSolution as refusal:
        assert 'margin' in str(refusal)
