from pathlib import Path

import numpy as np
import pytest

from hexapod_control.leg_jacobian import leg_jacobian, smallest_singular_value
from hexapod_control.leg_limits import LinearLimits
from hexapod_control.leg_motion import PAPER_LENGTH, PAPER_TARGET, level_pose
from hexapod_control.linear_geometry import PlatesConfig, PointsConfig, joint_circle
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError
from manipulator.machine import MachineFile

CONFIG = Path(__file__).parents[2] / 'config'
FILES = ['stewart_6_3.yaml', 'stewart_6_6.yaml']


def sections(name):
    machine = build(MachineFile, parse_yaml((CONFIG / name).read_text()))
    geometry = build(PlatesConfig, machine.geometry, 'geometry').geometry()
    return machine, geometry, build(LinearLimits, machine.limits, 'limits')


def lengths_at(geometry, position):
    return np.linalg.norm(geometry.platform_points + position - geometry.base_points, axis=1)


def test_joints_stand_on_circles_at_the_papers_angles():
    geometry = PlatesConfig(100, 50, 40, 10, 7, 5, 150).geometry()
    base = geometry.base_points * 1e3
    assert np.allclose(np.hypot(base[:, 0], base[:, 1]), 100)
    assert np.allclose(base[:, 2], 7)
    angles = np.degrees(np.arctan2(base[:, 1], base[:, 0])) % 360
    assert np.allclose(angles, [50, 70, 170, 190, 290, 310])
    platform = geometry.platform_points * 1e3
    assert np.allclose(np.hypot(platform[:, 0], platform[:, 1]), 40)
    assert np.allclose(platform[:, 2], -5)
    angles = np.degrees(np.arctan2(platform[:, 1], platform[:, 0])) % 360
    assert np.allclose(angles, [10, 110, 130, 230, 250, 350])


def test_a_platform_angle_of_zero_joins_joints_in_pairs():
    points = PlatesConfig(100, 50, 50, 0, 5, 5, 150).geometry().platform_points
    for one, other in [(0, 5), (1, 2), (3, 4)]:
        assert np.allclose(points[one], points[other])
    assert np.linalg.norm(points[0] - points[1]) == pytest.approx(0.05 * np.sqrt(3))


def test_joints_can_be_given_one_by_one():
    plates = PlatesConfig(100, 50, 50, 10, 5, 5, 150).geometry()
    content = {
        'base_joints_mm': (plates.base_points * 1e3).tolist(),
        'platform_joints_mm': (plates.platform_points * 1e3).tolist(),
        'home_height_mm': 150,
    }
    measured = build(PointsConfig, content).geometry()
    assert np.allclose(measured.base_points, plates.base_points)
    assert np.allclose(measured.platform_points, plates.platform_points)
    assert measured.home_height == pytest.approx(0.15)


def test_explicit_joints_that_cannot_fix_a_pose_are_refused():
    base = (joint_circle(100.0, 0.9) + np.array([3.0, 5.0, 0.0])).tolist()
    affine = [[0.5 * x + 0.1 * y, 0.4 * y, 0.0] for x, y, _ in base]
    content = {'base_joints_mm': base, 'platform_joints_mm': affine, 'home_height_mm': 150}
    with pytest.raises(ConfigError, match='no leg lengths fix a pose'):
        build(PointsConfig, content).geometry()


def test_an_empty_stroke_is_refused():
    with pytest.raises(ConfigError, match='is no range'):
        LinearLimits((200.0, 150.0), 45.0, 0.2, 50.0)


@pytest.mark.parametrize('name', FILES)
def test_machine_files_fit_the_papers_experiment_and_their_own_home(name):
    _, geometry, limits = sections(name)
    low, high = (1e-3 * x for x in limits.stroke_range_mm)
    start = level_pose(geometry, PAPER_LENGTH).position
    home = np.array([0, 0, geometry.home_height])
    for position in (start, np.array(PAPER_TARGET), home):
        lengths = lengths_at(geometry, position)
        assert (lengths > low).all()
        assert (lengths < high).all()
    assert np.allclose(lengths_at(geometry, home), 0.19, atol=1e-6)


@pytest.mark.parametrize('name', FILES)
def test_machine_files_keep_clear_of_singular_poses_from_start_to_target(name):
    _, geometry, limits = sections(name)
    for pose in (level_pose(geometry, PAPER_LENGTH), level_pose(geometry, 0.23)):
        jacobian = leg_jacobian(geometry.base_points, geometry.platform_points, pose)
        sigma = smallest_singular_value(jacobian, limits.characteristic_length_mm * 1e-3)
        assert sigma > limits.singularity_margin


@pytest.mark.parametrize('name', FILES)
def test_the_servos_of_machine_files_reach_every_stroke(name):
    machine, _, limits = sections(name)
    for joint in machine.servos['joints']:
        ends = [
            joint['centre_mm'] + (pulse - joint['centre_us']) / joint['us_per_mm']
            for pulse in joint['pulse_range_us']
        ]
        assert min(ends) <= limits.stroke_range_mm[0]
        assert max(ends) >= limits.stroke_range_mm[1]


def test_plates_face_each_other_below_the_base_as_above_it():
    above = PlatesConfig(100, 50, 50, 10, 7, 5, 180).geometry()
    below = PlatesConfig(100, 50, 50, 10, 7, 5, -180).geometry()
    upside_down = np.diag([1.0, 1.0, -1.0])
    np.testing.assert_allclose(below.base_points, above.base_points @ upside_down)
    np.testing.assert_allclose(below.platform_points, above.platform_points @ upside_down)
