"""Platforms whose home is not level, or not above the base's origin.

They are shipped machines, described in another base and with other axes of the platform.
"""

import dataclasses

import numpy as np
import pytest

from hexapod_control.geometry import JointsConfig
from hexapod_control.identification.models import geometry_lines
from hexapod_control.linear_geometry import LinearGeometry, PointsConfig
from hexapod_control.load import hexapod
from hexapod_control.workspace import sample
from hexarm import machines
from hexarm.machine_check import problems_of
from hexarm.simulation.model import mechanism
from hexarm.simulation.simulation import Simulation
from manipulator.config import build, parse_yaml
from manipulator.machine import MachineFile
from manipulator.pose import Pose

BASE = Pose.from_xyz_rpy([0.02, -0.03, 0.01], np.radians([0.0, 0.0, 25.0]))
AXES = Pose.from_xyz_rpy([0.0, 0.0, 0.0], np.radians([12.0, -7.0, 25.0]))


def in_millimetres(points):
    return (1e3 * np.asarray(points)).tolist()


def load(content):
    return hexapod(build(MachineFile, content))


def described_anew(machine):
    """A geometry section: with it home is BASE @ home @ AXES."""
    geometry, home = machine.kinematics.geometry, BASE @ machine.kinematics.home @ AXES
    section = {
        'platform_joints_mm': in_millimetres(geometry.platform_points @ AXES.rotation),
        'home_height_mm': 1e3 * float(home.position[2]),
        'home_xy_mm': in_millimetres(home.position[:2]),
        'home_rpy_deg': np.degrees(home.rpy).tolist(),
    }
    if isinstance(geometry, LinearGeometry):
        legs = {'base_joints_mm': in_millimetres(BASE.transform(geometry.base_points))}
    else:
        legs = {
            'crank_centres_mm': in_millimetres(BASE.transform(geometry.crank_centres)),
            'crank_tangents': (geometry.tangents @ BASE.rotation.T).tolist(),
            'crank_length_mm': in_millimetres(geometry.crank_lengths),
            'rod_length_mm': in_millimetres(geometry.rod_lengths),
        }
    return section | legs


@pytest.fixture(params=['robocake', 'stewart_6_6'])
def both(request, stewart_content):
    """The machine as it is shipped, and described anew."""
    content = stewart_content(request.param)
    plain = load(content)
    if 'minimum_height_mm' in content['limits']:
        content['limits']['minimum_height_mm'] += 1e3 * BASE.position[2]
    return plain, load(content | {'geometry': described_anew(plain)})


def test_the_machine_has_the_same_joints_and_limits_and_finds_the_same_poses(both):
    plain, moved = both
    poses = sample(plain, 200, np.random.default_rng(1))
    again = BASE @ poses @ AXES
    joints = plain.kinematics.inverse(poses)
    np.testing.assert_allclose(moved.kinematics.inverse(again), joints, atol=1e-9)
    margins = [
        np.minimum(values - m.constraints.low, m.constraints.high - values)
        for m, p in ((plain, poses), (moved, again))
        for values in [m.constraints.values(p, joints)]
    ]
    np.testing.assert_allclose(*margins, atol=2e-8)
    assert moved.constraints.admits(again, joints).all()
    for k in range(0, 200, 20):
        found = moved.kinematics.forward(joints[k]).pose
        assert np.abs(found.twist_to(again[k])).max() < 1e-8


def test_the_calibrated_geometry_that_is_written_keeps_home(both):
    _, moved = both
    lines = parse_yaml('\n'.join(['geometry:', *geometry_lines(moved.kinematics.geometry)]))
    schema = PointsConfig if 'base_joints_mm' in lines['geometry'] else JointsConfig
    again = build(schema, lines['geometry']).geometry()
    assert np.abs(again.home.twist_to(moved.kinematics.home)).max() < 1e-6


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6'])
def test_the_simulated_machine_closes_where_the_kinematics_says(name):
    file = machines.read(name)
    moved = load_geometry(file, described_anew(machines.load(name)))
    kinematics = moved.kinematics
    simulation = Simulation(
        mechanism(name, file, kinematics), kinematics.home, kinematics.inverse(kinematics.home)
    )
    assert simulation.closure_errors().max() < 1e-9
    poses = sample(moved, 20, np.random.default_rng(2))
    for k, joints in enumerate(kinematics.inverse(poses)):
        simulation.reset(poses[k], joints)
        assert simulation.closure_errors().max() < 1e-9
        assert np.abs(simulation.pose.twist_to(poses[k])).max() < 1e-9


def load_geometry(file, geometry):
    limits = {k: v for k, v in file.limits.items() if k != 'minimum_height_mm'}
    if 'minimum_height_mm' in file.limits:
        limits['minimum_height_mm'] = 0.0
    return hexapod(dataclasses.replace(file, geometry=geometry, limits=limits))


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6'])
def test_a_home_that_cannot_be_is_named(name):
    text = machines.text_of(machines.find(name))
    turned = text.replace('geometry:', 'geometry:\n  home_rpy_deg: [0, 500, 0]', 1)
    (problem,) = problems_of(turned)
    assert problem.startswith('geometry.home_rpy_deg[1]: 500 outside [-360, 360]')
    shifted = text.replace('geometry:', 'geometry:\n  home_xy_mm: [0, 200]', 1)
    assert any('home' in problem for problem in problems_of(shifted))
