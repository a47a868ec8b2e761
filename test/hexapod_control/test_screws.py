"""Legs on screws that turn with their cardan joints."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import yaml

from hexapod_control import load
from hexapod_control.identification.leg_model import Tolerances
from hexapod_control.identification.models import geometry_lines, model_of
from hexapod_control.linear import LinearPlatform
from hexapod_control.modes import all_modes
from hexapod_control.workspace import sample
from hexarm.machines import read
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.static_load import static_load
from leg_kinds import SCREW_LEGS
from manipulator import rotation as so3
from manipulator.config import build, parse_yaml
from manipulator.errors import ConfigError
from manipulator.machine import MachineFile
from manipulator.pose import Pose

LEAD = 0.012


@pytest.fixture(scope='module')
def content():
    return parse_yaml(Path(SCREW_LEGS).read_text())


@pytest.fixture(scope='module')
def screws():
    return load.hexapod(build(MachineFile, parse_yaml(Path(SCREW_LEGS).read_text())))


@pytest.fixture(scope='module')
def poses(screws):
    return sample(screws, 100, np.random.default_rng(1))


def without(kinematics, **changes):
    """The same platform with another geometry; by default with screws that never turn."""
    geometry = dataclasses.replace(kinematics.geometry, **(changes or {'screw_lead': 0.0}))
    return dataclasses.replace(kinematics, geometry=geometry)


def corrections(content, pose, lengths):
    """genhexkins' correction with the numbers of the file: lead · asin(nb3 · na2) / 2π."""
    g = {key: np.array(value) for key, value in content['geometry'].items()}
    gaps = pose.transform(1e-3 * g['platform_joints_mm']) - 1e-3 * g['base_joints_mm']
    units = gaps / lengths[:, None]
    nb3 = np.cross(units, np.cross(g['base_joint_axes'], units))
    na2 = np.cross(g['platform_joint_axes'] @ pose.rotation.T, units)
    nb3, na2 = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (nb3, na2))
    return 1e-3 * g['screw_lead_mm'] * np.arcsin((nb3 * na2).sum(axis=1)) / (2 * np.pi)


def test_joints_are_lengths_with_the_correction_of_linuxcnc(screws, content, poses):
    plain = without(screws.kinematics)
    for pose, joints in zip(poses, screws.kinematics.inverse(poses), strict=True):
        lengths = plain.inverse(pose)
        expected = lengths + corrections(content, pose, lengths)
        np.testing.assert_allclose(joints, expected, atol=1e-9)
        assert np.abs(joints - lengths).max() > 1e-4


def test_a_right_hand_screw_adds_its_lead_for_every_turn_of_the_platform_about_the_leg(screws):
    """Turned about leg 1's own line, at its joint on the platform: nothing else of leg 1 moves."""
    kinematics = screws.kinematics
    home = kinematics.home
    unit = kinematics.unit_rods(home, kinematics.inverse(home))[0]
    joint = home.transform(kinematics.geometry.platform_points)[0]
    for angle in (-0.3, 0.2, 0.5):
        turn = so3.exp(angle * unit)
        pose = Pose(joint + turn @ (home.position - joint), turn @ home.rotation)
        more = kinematics.inverse(pose)[0] - kinematics.inverse(home)[0]
        assert more == pytest.approx(LEAD * angle / (2 * np.pi), abs=1e-9)


def test_an_axis_told_in_its_other_direction_is_the_same_axis(screws, poses):
    sign = np.array([[1.0], [-1.0]] * 3)
    kinematics = screws.kinematics
    g = kinematics.geometry
    other = without(kinematics, base_axes=sign * g.base_axes, platform_axes=-g.platform_axes)
    np.testing.assert_allclose(other.inverse(poses), kinematics.inverse(poses), atol=1e-12)


def test_joint_rates_are_how_joints_follow_the_pose(screws, poses):
    kinematics, step = screws.kinematics, 1e-6
    rates = kinematics.joint_rates(poses, kinematics.inverse(poses))
    for axis, twist in enumerate(np.eye(6) * step):
        ahead, behind = (kinematics.inverse(poses.moved(t)) for t in (twist, -twist))
        np.testing.assert_allclose(rates[..., axis], (ahead - behind) / (2 * step), atol=1e-8)
    plain = without(kinematics)
    assert np.abs(rates - plain.joint_rates(poses, plain.inverse(poses))).max() > 1e-3


def test_all_modes_have_the_joints_and_one_is_the_machines(screws, poses):
    for k in range(5):
        joints = screws.kinematics.inverse(poses[k])
        modes = all_modes(screws, joints)
        for mode in modes.modes:
            again = screws.kinematics.inverse(mode.pose)
            np.testing.assert_allclose(again, joints, atol=1e-9)
            assert len(modes.other_than(mode.pose)) == len(modes.modes) - 1
        (found,) = modes.that_fit
        assert np.abs(poses[k].twist_to(found.pose)).max() < 1e-8


def test_identified_screws_are_written_and_read(screws, poses):
    model = model_of(screws.kinematics, Tolerances(5e-4, 0.02))
    errors = np.array([p.tolerance for p in model.parameters]) / 3
    values = errors * np.random.default_rng(4).standard_normal(len(errors))
    lines = ['geometry:', *geometry_lines(model.identified(values))]
    geometry = yaml.safe_load('\n'.join(lines))['geometry']
    built, _ = load.KINDS['linear_hexapod'].build(
        dataclasses.replace(read(SCREW_LEGS), geometry=geometry)
    )
    joints = screws.kinematics.inverse(poses)
    told = model.predict(values, joints, poses)
    for k in range(20):
        pose = built.forward(joints[k] + model.joint_offsets(values), poses[k]).pose
        assert np.abs(told[k].twist_to(pose)).max() < 5e-6


def test_efforts_hold_the_platform_by_virtual_work(screws, poses):
    """Of the platform alone: its height times its weight grows as the joints do work."""
    kinematics = screws.kinematics
    file = read(SCREW_LEGS)
    light = {**file.dynamics['cylinder'], 'mass_g': 0.001}
    thin = {**file.dynamics['piston'], 'mass_g': 0.001}
    nothing = {**file.dynamics['payload'], 'mass_g': 0.0}
    dynamics = {**file.dynamics, 'cylinder': light, 'piston': thin, 'payload': nothing}
    load_of = static_load(kinematics, dynamics_of(dataclasses.replace(file, dynamics=dynamics)))
    joints = kinematics.inverse(poses[0])
    efforts, step = load_of(poses[0], joints), 1e-6
    weight = 9.80665 * 1e-3 * file.dynamics['platform']['mass_g']
    for leg, change in enumerate(step * np.eye(6)):
        ahead, behind = (kinematics.forward(joints + s * change, poses[0]).pose for s in (1, -1))
        lift = (ahead.position[2] - behind.position[2]) / (2 * step)
        assert efforts[leg] == pytest.approx(weight * lift, rel=1e-3, abs=1e-4)


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        ({'base_joint_axes': None}, r'base_joint_axes: missing, screw_lead_mm is 12'),
        (
            {'platform_joint_axes': [[0.0, 0.0, 0.0]] * 6},
            r'leg 3: platform_joint_axes\[2\] has no direction',
        ),
        (
            {'base_joint_axes': 'along'},
            r'leg 2: base_joint_axes\[1\] is at 0\.\d° to its leg at home, .* needs 10° or more',
        ),
    ],
)
def test_joints_that_cannot_be_are_named(content, changes, words):
    g = content['geometry']
    if changes.get('base_joint_axes') == 'along':
        ends = np.add(g['platform_joints_mm'], (0.0, 0.0, g['home_height_mm']))
        changes = {'base_joint_axes': (ends - g['base_joints_mm']).tolist()}
    with pytest.raises(ConfigError, match=words):
        load.hexapod(build(MachineFile, {**content, 'geometry': {**g, **changes}}))


def test_axes_without_a_lead_turn_nothing(screws, poses):
    plain = without(screws.kinematics)
    assert isinstance(plain, LinearPlatform)
    ends = poses.transform(plain.geometry.platform_points) - plain.geometry.base_points
    np.testing.assert_allclose(plain.inverse(poses), np.linalg.norm(ends, axis=-1), rtol=1e-13)
