"""An arm that is not built as its file says, found again from 40 poses."""

import numpy as np
import pytest
import yaml

from arm_control.geometry import ScrewsConfig
from arm_control.identification.arm_model import geometry_lines
from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.machine_writer import machine_model, new_geometry
from hexarm.calibration.poses import telling_poses
from hexarm.machines import load
from manipulator.analysis.device_frames import DeviceFrames
from manipulator.analysis.identify import identify
from manipulator.analysis.measurements import Measurements, Noise
from manipulator.analysis.observability import model_directions, what_is_not_seen
from manipulator.config import build
from manipulator.pose import Pose

NOISE = Noise(1e-4, 1e-3)
BUILT = Tolerances(5e-4, np.radians(1.0))
SEEN = {'zeros', 'lengths', 'twists'}
FRAMES = DeviceFrames(
    Pose.from_xyz_rpy([1.0, 0.5, -0.2], [0.1, 0.2, 2.0]),
    Pose.from_xyz_rpy([0.0, 0.02, 0.05], [0.3, 0.0, -1.0]),
)


@pytest.fixture(params=['arm_6r', 'ur5', 'puma560'], scope='module')
def case(request):
    machine = load(request.param)
    model = machine_model(machine.kinematics, BUILT)
    joints, poses = telling_poses(machine, model, NOISE, 40)
    return machine, model, joints, poses


def some_values(model, seed=5):
    """Each parameter somewhere within its tolerance."""
    largest = [parameter.tolerance for parameter in model.parameters]
    return largest * np.random.default_rng(seed).uniform(-1.0, 1.0, len(largest))


def identified(case, true, groups):
    _, model, joints, poses = case
    seen = FRAMES.seen(model.predict(true, joints, poses))
    generator = np.random.default_rng(5)
    seen = seen.moved(generator.standard_normal((len(joints), 6)) / NOISE.weights)
    measured = Measurements(joints, seen)
    return identify(model, measured, NOISE, poses, groups | {'device', 'marker'})


def unseen(model, found):
    free = found.is_free
    motions = model_directions(model.rigid_motions(found.model_values), free)
    names = tuple(p for p, is_free in zip(found.parameters, free, strict=True) if is_free)
    deviations = found.deviations[free]
    return what_is_not_seen(found.slopes[:, free], names, deviations, motions).unseen


def test_proposed_poses_are_within_the_joint_ranges_and_above_the_base(case):
    machine, _, joints, poses = case
    limits = machine.kinematics.limits
    assert ((limits.low < joints) & (joints < limits.high)).all()
    assert (poses.position[:, 2] > 0.0).all()


def test_each_parameter_does_what_its_slope_says(case):
    _, model, joints, poses = case
    values, step = some_values(model), 1e-7
    here = model.predict(values, joints, poses)
    slopes = model.slopes(values, joints, here)
    for k, parameter in enumerate(model.parameters):
        there = model.predict(values + step * np.eye(len(values))[k], joints, poses)
        found = here.twist_to(there) / step
        assert np.abs(found - slopes[:, :, k]).max() < 1e-6, parameter.name


def test_with_no_errors_it_is_the_arm_of_the_file(case):
    machine, model, joints, _ = case
    chain, same = machine.kinematics.chain, model.identified(np.zeros(21))
    apart = chain.forward(joints).twist_to(same.forward(joints))
    assert np.abs(apart).max() < 1e-12


def test_zeros_are_found_but_for_the_first_and_last_which_the_frames_make_up_for(case):
    model = case[1]
    true = some_values(model) * (np.arange(21) < 6)
    found = identified(case, true, {'zeros'})
    assert np.abs(found.model_values - true)[1:5].max() < np.radians(0.05)
    assert np.abs(true)[1:5].max() > np.radians(0.5)
    dark = unseen(model, found)
    assert len(dark) == 2
    assert 'joint 1' in dark[0]
    assert dark[0].endswith('made up for by the device')
    assert 'joint 6' in dark[1]
    assert dark[1].endswith('made up for by the marker')


def test_links_are_found_and_what_only_the_frames_know_is_named(case):
    model = case[1]
    true = some_values(model)
    found = identified(case, true, SEEN)
    dark = unseen(model, found)
    assert len(dark) == 3
    assert sum('the base' in name for name in dark) == 2
    assert all('made up for by' in name for name in dark)
    lengths = [k for k, p in enumerate(model.parameters) if p.name == 'link 2 length']
    assert np.abs(found.model_values - true)[lengths].max() < 1e-4


def test_poses_that_were_not_measured_come_out_well(case):
    machine, model, _, _ = case
    true = some_values(model)
    found = identified(case, true, SEEN)
    joints = np.random.default_rng(8).uniform(-1.0, 1.0, (1000, 6)) + machine.kinematics.rest
    near = machine.kinematics.chain.forward(joints)
    truth = FRAMES.seen(model.predict(true, joints, near)).position
    told = found.frames.seen(model.predict(found.model_values, joints, near)).position
    assert np.sqrt(((told - truth) ** 2).mean(axis=0)).max() < 1e-4


def test_the_lines_of_the_file_make_the_same_arm(case):
    machine, model, joints, _ = case
    chain = model.identified(some_values(model))
    lines = geometry_lines(chain, machine.kinematics.rest)
    config = build(ScrewsConfig, yaml.safe_load('\n'.join(lines)), 'geometry')
    apart = chain.forward(joints).twist_to(config.chain().forward(joints))
    assert np.abs(apart).max() < 1e-6
    assert np.allclose(np.radians(config.home_deg), machine.kinematics.rest, atol=1e-8)


def test_zeros_alone_stand_in_the_servos_and_leave_the_geometry(case):
    model = case[1]
    assert new_geometry(model, some_values(model) * (np.arange(21) < 6)) == []
    assert new_geometry(model, some_values(model))[0] == '  screws:'
