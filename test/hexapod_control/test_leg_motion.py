import numpy as np
import pytest
from euler import from_zxz

from hexapod_control.leg_motion import LegMotion, leg_motion, level_pose, paper_motion
from hexapod_control.linear_geometry import LinearGeometry, PlatesConfig
from hexarm.papers.plane_method import PlaneMethod
from manipulator import rotation as so3
from manipulator.arrays import frozen
from manipulator.errors import ConfigError, InvalidInput, Unreachable
from manipulator.pose import Pose
from newton import Newton


def plates(base_degrees, platform_degrees):
    return PlatesConfig(100, base_degrees, 50, platform_degrees, 5, 5, 180)


def motion(config, steps=100):
    method = PlaneMethod.of(config)

    def solve(lengths, near):
        return method.solve(lengths, near).pose

    return paper_motion(config.geometry(), solve, steps)


@pytest.mark.parametrize('angles', [(50, 10), (50, 0), (30, 0), (10, 0)])
def test_legs_change_linearly_and_poses_have_these_lengths(angles):
    config = plates(*angles)
    geometry, run = config.geometry(), motion(config)
    assert np.allclose(np.diff(run.lengths, axis=0, n=2), 0.0, atol=1e-15)
    rods = run.poses.transform(geometry.platform_points) - geometry.base_points
    assert np.allclose(np.linalg.norm(rods, axis=-1), run.lengths, atol=1e-11)
    assert np.allclose(run.lengths[0], 0.15)
    assert np.allclose(run.poses.position[-1], [0.02, 0.02, 0.2], atol=1e-11)
    assert np.allclose(run.poses.rotation[-1], np.eye(3), atol=1e-9)


def test_linear_legs_do_not_give_a_linear_pose():
    per_axis, angle = [], []
    for angles in [(50, 10), (50, 0), (10, 0)]:
        run = motion(plates(*angles))
        off = run.poses.position - run.straight.position
        per_axis.append(np.abs(off).max())
        angle.append(run.angle_deviation.max())
        assert run.position_deviation.max() == pytest.approx(np.linalg.norm(off, axis=1).max())
    assert per_axis == pytest.approx([1.326e-3, 1.378e-3, 1.227e-3], abs=1e-6)
    assert np.degrees(angle) == pytest.approx([0.0261, 0.0321, 0.0448], abs=1e-4)


def test_equal_lengths_give_the_6_6_and_the_6_3_different_heights():
    heights = [level_pose(plates(50, a).geometry(), 0.15).position[2] for a in (10, 0)]
    assert heights == pytest.approx([0.142893, 0.138171], abs=1e-6)


@pytest.mark.parametrize(('platform_degrees', 'least'), [(0, -0.0321), (10, -0.0261)])
def test_angles_of_the_motion_are_continuous_and_give_its_rotations(platform_degrees, least):
    """As figs 7 and 9: α and γ near zero, β below it; steps of half a turn are no motion."""
    run = motion(plates(50, platform_degrees))
    degrees = np.degrees(run.euler_zxz)
    assert np.allclose(from_zxz(run.euler_zxz), run.poses.rotation, atol=1e-6)
    assert np.abs(np.diff(degrees, axis=0)).max() < 0.1
    assert np.abs(degrees[:, [0, 2]]).max() < 0.35
    assert degrees[:, 1].min() == pytest.approx(least, abs=1e-4)
    assert degrees[:, 1].max() < 1e-6
    assert np.allclose(so3.exp(run.rotation_vectors), run.poses.rotation, atol=1e-12)


def test_the_papers_singular_choice_is_refused_and_explained():
    with pytest.raises(ConfigError, match='hexagons are similar'):
        motion(plates(20, 20))


def test_newton_gives_the_same_motion():
    geometry = plates(50, 10).geometry()
    newton = Newton(geometry.platform_points, 0.05)

    def solve(lengths, near):
        return newton.solve(geometry.base_points, lengths, near).pose

    one, other = paper_motion(geometry, solve, 20), motion(plates(50, 10), 20)
    assert np.allclose(one.poses.position, other.poses.position, atol=1e-10)
    assert np.allclose(one.poses.rotation, other.poses.rotation, atol=1e-9)


def test_a_straight_motion_deviates_nowhere():
    first = Pose(np.array([0.0, 0.0, 0.1]), so3.exp([0.1, 0.2, -0.1]))
    share = np.linspace(0, 1, 11)[:, None]
    poses = first.moved(share * np.array([0.1, 0.2, 0.3, 0.3, -0.2, 0.1]))
    run = LegMotion(frozen(np.zeros((11, 6))), poses)
    assert run.position_deviation.max() < 1e-15
    assert run.angle_deviation.max() < 1e-7


def test_a_motion_needs_a_step():
    with pytest.raises(InvalidInput, match='0 steps'):
        leg_motion(lambda _, near: near, np.ones(6), np.ones(6), Pose.identity(), 0)


def test_a_level_pose_needs_long_and_like_legs():
    geometry = plates(50, 10).geometry()
    with pytest.raises(Unreachable, match='leg 1'):
        level_pose(geometry, 0.02)
    skew = geometry.base_points + np.array([[0.01, 0, 0]] + [[0, 0, 0]] * 5)
    with pytest.raises(Unreachable, match='no level pose'):
        level_pose(LinearGeometry(skew, geometry.platform_points, 0.15), 0.15)
