import re

import numpy as np
import pytest

from hexapod_control.load import hexapod
from hexarm import machines
from manipulator.config import build
from manipulator.errors import ConfigError, LimitViolated
from manipulator.machine import MachineFile
from manipulator.pose import Pose


def load(content):
    return hexapod(build(MachineFile, content))


def test_limits_are_those_of_the_file(robocake_content):
    machine = load(robocake_content)
    quantities = {limit.quantity: limit for limit in machine.constraints.limits}
    np.testing.assert_allclose(np.degrees(quantities['crank angle'].high), 210.0)
    assert quantities['platform height'].low[0] == pytest.approx(0.02339)
    assert quantities['singularity margin'].low[0] == 0.3
    assert len(quantities) == 7
    assert machine.kinematics.joint_names[5] == 'crank_6'
    assert machine.motion.joint.speed == pytest.approx(np.radians(480))


def test_a_limit_broken_is_reported_with_its_leg(robocake_content):
    robocake_content['limits']['crank_range_deg'] = [100.0, 140.0]
    machine = load(robocake_content)
    pose = Pose.from_xyz_rpy([0.01, 0.0, 0.04119])
    with pytest.raises(LimitViolated, match=r'leg \d: crank angle') as caught:
        machine.constraints.check(pose, machine.kinematics.inverse(pose))
    assert caught.value.leg in range(1, 7)


def test_misspelt_keys_are_named_with_the_right_ones(robocake_content):
    robocake_content['geometry']['rod_lenght_mm'] = 58.0
    with pytest.raises(ConfigError, match="did you mean 'rod_length_mm'"):
        load(robocake_content)
    del robocake_content['geometry']['rod_lenght_mm']
    robocake_content['limits']['minimum_heigth_mm'] = 1.0
    with pytest.raises(ConfigError, match="did you mean 'minimum_height_mm'"):
        load(robocake_content)


def test_an_unknown_kind_is_refused(robocake_content):
    with pytest.raises(ConfigError, match='kind'):
        load(robocake_content | {'kind': 'octopod'})


@pytest.mark.parametrize('bounds', [[210.0, 30.0], [30.0, 30.0], [0.0, 400.0]])
def test_a_crank_range_that_is_none_is_refused(robocake_content, bounds):
    robocake_content['limits']['crank_range_deg'] = bounds
    with pytest.raises(ConfigError, match='crank_range_deg'):
        load(robocake_content)


def test_a_home_beyond_a_limit_is_refused(robocake_content):
    robocake_content['limits']['crank_range_deg'] = [130.0, 200.0]
    with pytest.raises(ConfigError, match=r'home has crank angle 120° on all legs, outside'):
        load(robocake_content)


def test_a_model_that_does_not_close_is_refused(robocake_content):
    robocake_content['geometry']['rod_length_mm'] = [58.0, 58.0, 20.0, 58.0, 58.0, 58.0]
    with pytest.raises(ConfigError, match='leg 3: rod too short by'):
        load(robocake_content)


def test_machines_by_coordinates_load_as_well(robocake_content):
    g = load(robocake_content).kinematics.geometry
    coordinates = {
        'crank_centres_mm': (g.crank_centres * 1e3).tolist(),
        'crank_tangents': g.tangents.tolist(),
        'platform_joints_mm': (g.platform_points * 1e3).tolist(),
        'crank_length_mm': 17.5,
        'rod_length_mm': 58.0,
        'home_height_mm': 41.19,
    }
    kinematics = load(robocake_content | {'geometry': coordinates}).kinematics
    np.testing.assert_allclose(
        np.degrees(kinematics.inverse(kinematics.home)), 120.0045, atol=5e-5
    )


@pytest.mark.parametrize('name', ['stewart_6_3', 'stewart_6_6'])
def test_linear_limits_are_those_of_the_file(stewart_content, name):
    machine = load(stewart_content(name))
    quantities = {limit.quantity: limit for limit in machine.constraints.limits}
    np.testing.assert_allclose(quantities['leg length'].high, 0.238)
    np.testing.assert_allclose(np.degrees(quantities['base joint swing'].high), 45.0)
    np.testing.assert_allclose(np.degrees(quantities['platform joint swing'].high), 45.0)
    assert quantities['singularity margin'].low[0] == 0.25
    assert len(quantities) == 4
    assert machine.kinematics.joint_names[5] == 'leg_6'
    assert machine.kinematics.joint_unit == 'm'
    assert machine.motion.joint.speed == pytest.approx(0.02)


def test_linear_machines_by_coordinates_load_as_well(stewart_content):
    content = stewart_content('stewart_6_6')
    kinematics = load(content).kinematics
    g = kinematics.geometry
    coordinates = {
        'base_joints_mm': (g.base_points * 1e3).tolist(),
        'platform_joints_mm': (g.platform_points * 1e3).tolist(),
        'home_height_mm': g.home_height * 1e3,
    }
    again = load(content | {'geometry': coordinates}).kinematics
    np.testing.assert_allclose(again.inverse(again.home), kinematics.inverse(kinematics.home))


def test_a_linear_home_beyond_the_stroke_is_refused(stewart_content):
    content = stewart_content('stewart_6_6')
    content['geometry']['home_height_mm'] = 260.0
    with pytest.raises(ConfigError, match=r'home has leg length 259\.5 mm on all legs, outside'):
        load(content)


def test_the_papers_equal_joint_angles_are_refused_when_the_file_is_loaded(tmp_path):
    """Lapikov et al. 2014, section 4: φb = φmp, for the 6-6."""
    text = machines.find('stewart_6_6').read_text()
    path = tmp_path / 'paper.yaml'
    path.write_text(re.sub('base_angle_deg: 50.0', 'base_angle_deg: 10.0', text))
    with pytest.raises(ConfigError, match='no leg lengths fix a pose') as caught:
        machines.load(str(path))
    assert str(path) in str(caught.value)
    assert 'give them different joint angles' in str(caught.value)


def test_a_crank_platform_that_no_rods_can_hold_is_refused(robocake_content):
    """All its joints lie on one straight line, about which it turns freely."""
    g = load(robocake_content).kinematics.geometry
    joints = 1e3 * g.platform_points * [1.0, 0.0, 0.0]
    gaps = joints + np.array([0.0, 0.0, 41.19]) - 1e3 * g.crank_centres
    coordinates = {
        'crank_centres_mm': (g.crank_centres * 1e3).tolist(),
        'crank_tangents': g.tangents.tolist(),
        'platform_joints_mm': joints.tolist(),
        'crank_length_mm': 10.0,
        'rod_length_mm': np.linalg.norm(gaps, axis=1).tolist(),
        'home_height_mm': 41.19,
    }
    with pytest.raises(ConfigError, match='no leg lengths fix a pose'):
        load(robocake_content | {'geometry': coordinates})
