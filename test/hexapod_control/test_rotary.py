from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexapod_control import load
from hexapod_control.geometry import HexagonConfig, RotaryGeometry
from hexapod_control.rotary import RotaryHexapod
from hexapod_control.workspace import sample
from leg_kinds import FLAT_CRANKS, TILTED_CRANKS
from manipulator import rotation
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.machine import MachineFile
from manipulator.pose import Pose


def rod_lengths(hexapod, pose, joints):
    """By definition: crank tips from rotation of the crank, platform joints from the pose."""
    g = hexapod.geometry
    turned = np.cos(joints)[..., None] * g.tangents + np.sin(joints)[..., None] * g.ups
    tips = g.crank_centres + g.crank_lengths[:, None] * turned
    ends = np.einsum('...ij,kj->...ki', pose.rotation, g.platform_points)
    return np.linalg.norm(ends + pose.position[..., None, :] - tips, axis=-1)


@pytest.mark.parametrize('path', [TILTED_CRANKS, FLAT_CRANKS])
def test_cranks_turn_about_the_axes_of_the_file_by_the_right_hand(path):
    """From the numbers of the file alone: the tangent turned about the axis ends where rods do."""
    content = parse_yaml(Path(path).read_text())
    g = {key: np.array(value) for key, value in content['geometry'].items()}
    machine = load.hexapod(build(MachineFile, content))
    poses = sample(machine, 300, np.random.default_rng(1))
    for pose, joints in zip(poses, machine.kinematics.inverse(poses), strict=True):
        turned = rotation.exp(joints[:, None] * g['crank_axes'])
        arms = g['crank_length_mm'] * np.einsum('lij,lj->li', turned, g['crank_tangents'])
        ends = pose.transform(1e-3 * g['platform_joints_mm'])
        gaps = np.linalg.norm(1e3 * ends - g['crank_centres_mm'] - arms, axis=1)
        np.testing.assert_allclose(gaps, g['rod_length_mm'], atol=2e-5)


def moved_by(dx=0.0, dy=0.0, dz=0.0, roll=0.0, pitch=0.0, yaw=0.0):
    return Pose.from_xyz_rpy([dx, dy, 0.04119 + dz], [roll, pitch, yaw])


def test_home_angles_are_those_of_the_paper(hexapod):
    degrees = np.degrees(hexapod.inverse(hexapod.home))
    np.testing.assert_allclose(degrees, 120.0045, atol=5e-5)


def test_the_other_elbow_at_home(hexapod):
    degrees = np.degrees(hexapod.inverse(hexapod.home, near=np.zeros(6)))
    np.testing.assert_allclose(degrees, -21.9792, atol=5e-5)


def test_rods_keep_their_length_over_the_whole_workspace(hexapod, many):
    lengths = rod_lengths(hexapod, many, hexapod.inverse(many))
    assert np.abs(lengths - 0.058).max() < 1e-12


def test_rods_keep_their_length_on_the_other_elbow(hexapod, many):
    joints = hexapod.inverse(many[:500], near=np.zeros(6))
    assert np.abs(rod_lengths(hexapod, many[:500], joints) - 0.058).max() < 1e-12
    assert (hexapod.joint_gains(many[:500], joints) >= -1e-9).any()


def test_each_crank_may_be_near_another_elbow_and_another_turn(hexapod):
    pose = moved_by(0.003, -0.002, 0.004, 0.03)
    elbow_out = hexapod.inverse(pose)
    elbow_in = hexapod.inverse(pose, np.zeros(6))
    wanted = np.where([True, False] * 3, elbow_out + 2 * np.pi, elbow_in - 4 * np.pi)
    np.testing.assert_allclose(hexapod.inverse(pose, wanted + 0.1), wanted, atol=1e-12)


def test_near_may_differ_from_pose_to_pose(hexapod):
    poses = Pose(np.tile(hexapod.home.position, (2, 1)), np.tile(np.eye(3), (2, 1, 1)))
    joints = hexapod.inverse(poses, np.array([np.full(6, 2.0), np.zeros(6)]))
    np.testing.assert_allclose(np.degrees(joints[:, 0]), [120.0045, -21.9792], atol=5e-5)


def test_near_is_broadcast_over_the_poses(hexapod):
    position, rotation = hexapod.home.position, hexapod.home.rotation
    poses = Pose(np.tile(position, (2, 3, 1)), np.tile(rotation, (2, 3, 1, 1)))
    joints = hexapod.inverse(poses, np.array([[np.full(6, 2.0)], [np.zeros(6)]]))
    elbows = np.array([np.full((3, 6), 120.0045), np.full((3, 6), -21.9792)])
    np.testing.assert_allclose(np.degrees(joints), elbows, atol=5e-5)


def test_angles_are_continuous_where_a_joint_passes_over_the_crank_axis(robocake_content):
    content = {**robocake_content['geometry'], 'crank_shift_mm': 0.0, 'joint_shift_mm': 0.0}
    geometry = build(HexagonConfig, content | {'home_height_mm': 50.0}).geometry()
    machine = RotaryHexapod(geometry, 0.07, 0.3, np.radians(120.0))
    poses = Pose.from_xyz_rpy([[0.0, y, 0.05] for y in np.linspace(-0.01, 0.01, 2001)])
    joints = machine.inverse(poses)
    gap = poses.transform(geometry.platform_points)[:, 0] - geometry.crank_centres[0]
    across = gap @ geometry.tangents[0]
    assert across[0] * across[-1] < 0
    assert np.abs(np.diff(joints, axis=0)).max() < 1e-3
    assert np.abs(rod_lengths(machine, poses, joints) - 0.058).max() < 1e-12


@pytest.mark.parametrize('centre', [-2.0, 0.0, 2.0, 9.0])
def test_angles_stay_within_half_a_turn_of_the_crank_centre(hexapod, many, centre):
    other = RotaryHexapod(hexapod.geometry, 0.07, 0.3, centre)
    joints = other.inverse(many)
    assert np.abs(joints - centre).max() <= np.pi + 1e-12
    turns = (joints - hexapod.inverse(many)) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.rint(turns), atol=1e-12)


@pytest.mark.parametrize('centre', [-2.0, 0.0, 2.0, 9.0])
def test_every_way_to_bend_the_legs_closes_them_within_half_a_turn_of_the_crank_centre(
    hexapod, centre
):
    other, pose = RotaryHexapod(hexapod.geometry, 0.07, 0.3, centre), moved_by(0.003, 0.0, 0.004)
    every = other.inverse_all(pose)
    assert np.abs(every - centre).max() <= np.pi + 1e-12
    assert len(np.unique(every.round(6), axis=0)) == 64
    poses = Pose(np.tile(pose.position, (64, 1)), np.tile(pose.rotation, (64, 1, 1)))
    assert np.abs(rod_lengths(other, poses, every) - 0.058).max() < 1e-12
    np.testing.assert_allclose(every[0], other.inverse(pose), atol=1e-12)


def test_elbow_in_is_chosen_where_it_is_nearer_by_more_than_a_tenth_of_a_radian(hexapod):
    out, inside = hexapod.inverse(hexapod.home), hexapod.inverse(hexapod.home, np.zeros(6))
    middle = (out + inside) / 2
    for nearer, expected in ((0.08, out), (0.12, inside), (1.0, inside)):
        near = middle + np.sign(inside - out) * nearer / 2
        np.testing.assert_allclose(hexapod.inverse(hexapod.home, near), expected, atol=1e-12)


def test_many_chunks_give_what_one_gives(hexapod, many):
    twice = Pose(np.concatenate([many.position] * 2), np.concatenate([many.rotation] * 2))
    joints = hexapod.inverse(twice)
    np.testing.assert_array_equal(joints[: len(many.position)], joints[len(many.position) :])
    np.testing.assert_allclose(joints[2900], hexapod.inverse(many[2900]), rtol=1e-13)


@pytest.mark.parametrize('xyz', [(0.0, 0.0, 0.060), (0.017, 0.0, 0.04119), (0.0, -0.02, 0.04)])
def test_unreachable_pose_says_which_rod_is_short_and_by_how_much(hexapod, xyz):
    with pytest.raises(Unreachable, match=r'leg \d: rod too short by') as caught:
        hexapod.inverse(Pose.from_xyz_rpy(xyz))
    miss = float(str(caught.value).split(' by ')[1].split(' mm')[0])
    g, leg = hexapod.geometry, caught.value.leg - 1
    angles = np.linspace(-np.pi, np.pi, 100_001)
    tips = g.crank_centres[leg] + g.crank_lengths[leg] * (
        np.cos(angles)[:, None] * g.tangents[leg] + np.sin(angles)[:, None] * g.ups[leg]
    )
    gap = np.linalg.norm(g.platform_points[leg] + xyz - tips, axis=1).min()
    assert miss == pytest.approx(1e3 * (gap - g.rod_lengths[leg]), rel=0.01)


def test_a_rod_too_long_is_named_as_such(hexapod):
    g = hexapod.geometry
    inside = Pose.from_xyz_rpy(g.crank_centres[2] - g.platform_points[2] + [0, 0, 1e-3])
    with pytest.raises(Unreachable, match='leg 3: rod too long by'):
        hexapod.inverse(inside)


def test_near_that_is_not_finite_is_refused(hexapod):
    with pytest.raises(InvalidInput, match='near'):
        hexapod.inverse(hexapod.home, np.array([np.nan] + [2.0] * 5))


def test_a_model_that_does_not_close_names_leg_and_lengths(hexapod):
    g = hexapod.geometry
    rods = [0.058] * 3 + [0.030] + [0.058] * 2
    short = RotaryGeometry(
        g.crank_centres, g.tangents, g.platform_points, g.crank_lengths, rods, 0.04119
    )
    with pytest.raises(ConfigError, match=r'leg 4: rod too short by .* \(30 mm, needs'):
        RotaryHexapod(short, 0.07, 0.3, 2.0)


def test_joint_rates_are_how_angles_follow_the_pose(hexapod, many):
    poses, step = many[:200], 1e-7
    joints = hexapod.inverse(poses)
    rates = hexapod.joint_rates(poses, joints)
    for axis, twist in enumerate(np.eye(6) * step):
        ahead, behind = (hexapod.inverse(poses.moved(t)) for t in (twist, -twist))
        slope = (ahead - behind) / (2 * step)
        np.testing.assert_allclose(rates[..., axis], slope, rtol=1e-4, atol=1e-3)


def test_leverage_vanishes_where_crank_and_rod_come_into_line(hexapod):
    leverage = []
    for dx in (0.0, 0.014, 0.0156, 0.015627):
        pose = moved_by(dx)
        leverage.append(hexapod.leverage(pose, hexapod.inverse(pose)).min())
    assert leverage == sorted(leverage, reverse=True)
    assert leverage[0] > 0.5
    assert leverage[-1] < 0.01


def test_crank_and_rod_in_line_have_no_rates(hexapod):
    g = hexapod.geometry
    pose = hexapod.home
    rod = pose.transform(g.platform_points)[0] - g.crank_centres[0]
    joints = hexapod.inverse(pose).copy()
    joints[0] = np.arctan2(rod @ g.ups[0], rod @ g.tangents[0])
    with pytest.raises(NoSolution, match='in line'):
        hexapod.joint_rates(pose, joints)


def singular_pose(hexapod):
    """The height at which det J vanishes on the way down from home, by bisection."""

    def side(height):
        pose = Pose.from_xyz_rpy([0.0, 0.0, height])
        joints = hexapod.inverse(pose)
        return np.linalg.det(hexapod.leg_jacobian(pose, joints)) * hexapod.home_side, pose, joints

    low, high = 0.005, 0.030
    assert side(low)[0] < 0 < side(high)[0]
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (low, middle) if side(middle)[0] > 0 else (middle, high)
    return side(low)[1:]


def test_jacobian_refuses_a_forward_singularity(hexapod):
    pose, joints = singular_pose(hexapod)
    assert hexapod.sigma_min(pose, joints) < 1e-9
    with pytest.raises(NoSolution, match='singularity'):
        hexapod.jacobian(pose, joints)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_any_crank_machine_closes_and_comes_back(seed):
    """RoboCake with joints, lengths and crank planes of its own in every leg."""
    generator = np.random.default_rng(seed)
    turn = np.arange(6) * np.pi / 3
    sigma = np.array([-1.0, 1.0] * 3)

    def around(radial, along, height):
        x, y = (np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))
        flat = np.multiply(x, radial) + np.multiply(y, along)
        return np.vstack([flat, np.broadcast_to(height, 6)]).T

    machine = RotaryHexapod(
        RotaryGeometry(
            around(96.5, sigma * 5.8, 0.0) * 1e-3 + generator.uniform(-2e-3, 2e-3, (6, 3)),
            around(0.0, -sigma, 0.0) + generator.uniform(-0.1, 0.1, (6, 3)),
            around(70.0, -sigma * 30.0, 0.0) * 1e-3 + generator.uniform(-2e-3, 2e-3, (6, 3)),
            generator.uniform(0.016, 0.020, 6),
            generator.uniform(0.057, 0.060, 6),
            0.041,
        ),
        0.07,
        0.2,
        2.0,
    )
    twists = generator.uniform(-1, 1, (20, 6)) * ([0.004] * 3 + [0.06] * 3)
    start = Pose(np.tile(machine.home.position, (20, 1)), machine.home.rotation)
    poses = start.moved(twists)
    joints = machine.inverse_or_nan(poses)
    closed = np.isfinite(joints).all(axis=1)
    assert closed.sum() >= 10
    poses, joints = poses[closed], joints[closed]
    assert np.abs(rod_lengths(machine, poses, joints) - machine.geometry.rod_lengths).max() < 1e-12
    for k, angles in enumerate(joints):
        found = machine.forward(angles).pose
        assert np.abs(poses[k].twist_to(found)).max() < 1e-8
