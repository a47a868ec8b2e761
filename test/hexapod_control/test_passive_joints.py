import numpy as np
import pytest

from hexapod_control.leg_limits import crank_joint_tilt, platform_joint_swing
from manipulator.pose import Pose


def rods(hexapod, pose, joints):
    g = hexapod.geometry
    ends = g.platform_points @ pose.rotation.T + pose.position
    turned = np.cos(joints)[:, None] * g.tangents + np.sin(joints)[:, None] * g.ups
    return (ends - g.crank_centres - g.crank_lengths[:, None] * turned) / g.rod_lengths[:, None]


@pytest.fixture
def swing(hexapod):
    return platform_joint_swing(hexapod, 0.5)


@pytest.fixture
def tilt(hexapod):
    return crank_joint_tilt(hexapod, 0.3)


def test_nothing_swings_at_home(hexapod, swing, tilt):
    joints = hexapod.inverse(hexapod.home)
    np.testing.assert_allclose(swing.values(hexapod.home, joints), 0.0, atol=1e-7)
    np.testing.assert_allclose(tilt.values(hexapod.home, joints), 0.0, atol=1e-12)


def test_platform_joints_see_the_rod_from_the_platform(hexapod, swing):
    pose = Pose.from_xyz_rpy([0.004, 0.002, 0.038], [0.1, -0.1, 0.08])
    joints = hexapod.inverse(pose)
    now = rods(hexapod, pose, joints) @ pose.rotation
    then = rods(hexapod, hexapod.home, hexapod.inverse(hexapod.home))
    angles = [
        np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b) for a, b in zip(now, then, strict=True)
    ]
    np.testing.assert_allclose(swing.values(pose, joints), angles, atol=1e-9)


def test_crank_joints_turn_freely_about_their_bolt(hexapod, tilt):
    low = Pose.from_xyz_rpy([0.0, 0.0, 0.0295])
    joints = hexapod.inverse(low)
    assert np.degrees(np.abs(joints - hexapod.inverse(hexapod.home))).min() > 15
    np.testing.assert_allclose(tilt.values(low, joints), 0.0, atol=1e-12)


@pytest.mark.parametrize('side', [1, -1])
def test_a_rod_at_a_right_angle_to_its_cranks_plane_has_a_tilt(hexapod, tilt, side):
    """Rounding may make its sine a little more than one."""
    g, joints = hexapod.geometry, np.linspace(0.0, 3.0, 200)[:, None].repeat(6, axis=1)
    at_home = np.arcsin(
        (rods(hexapod, hexapod.home, hexapod.inverse(hexapod.home)) * g.normals).sum(1)
    )
    for leg, tips in enumerate(hexapod.crank_tips(joints).swapaxes(0, 1)):
        ends = tips + side * g.rod_lengths[leg] * g.normals[leg]
        poses = Pose.from_xyz_rpy(ends - g.platform_points[leg])
        values = tilt.values(poses, joints)[:, leg]
        np.testing.assert_allclose(values, side * np.pi / 2 - at_home[leg], atol=1e-7)


def test_crank_joints_tilt_by_what_the_platform_moves_outward(hexapod, tilt):
    pose = Pose.from_xyz_rpy([0.01, 0.0, 0.04119])
    change = tilt.values(pose, hexapod.inverse(pose))[0]
    # Leg 1 stands on the x axis: its joint is 26.5 mm inside the crank's plane, then 16.5 mm.
    assert abs(change) == pytest.approx(np.arcsin(26.5 / 58) - np.arcsin(16.5 / 58), abs=1e-4)


def test_limits_name_the_leg(robocake, hexapod):
    pose = Pose.from_xyz_rpy([0.0, 0.0, 0.0412], [0.33, 0.0, 0.0])
    violations = [str(v) for v in robocake.constraints.violations(pose, hexapod.inverse(pose))]
    assert violations
    narrow = platform_joint_swing(hexapod, 0.2)
    values = narrow.values(pose, hexapod.inverse(pose))
    assert (values > narrow.high).any()
    assert narrow.owners[2] == 'leg 3'


def test_swing_broadcasts_over_poses(hexapod, swing, tilt):
    poses = Pose.from_xyz_rpy([[0.002 * k, 0.0, 0.04] for k in range(4)])
    joints = hexapod.inverse(poses)
    for limit in (swing, tilt):
        together = limit.values(poses, joints)
        assert together.shape == (4, 6)
        np.testing.assert_allclose(together[3], limit.values(poses[3], joints[3]), atol=1e-9)
