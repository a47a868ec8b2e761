"""Slopes by differences, poses by the closure of the legs, and the machine files they become."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from hexapod_control.geometry import HexagonConfig, JointsConfig
from hexapod_control.identification.leg_model import Tolerances
from hexapod_control.identification.models import geometry_lines, model_of
from hexapod_control.load import KINDS
from hexapod_control.workspace import sample
from hexarm.machines import load, read
from leg_kinds import RAILS, TILTED_CRANKS
from manipulator.analysis.device_frames import DeviceFrames
from manipulator.config import build
from manipulator.errors import InvalidInput, NoSolution
from manipulator.pose import Pose

MACHINES = ['robocake', 'stewart_6_3', 'stewart_6_6', TILTED_CRANKS, RAILS]
BUILT = Tolerances(5e-4, np.radians(1.0))


@pytest.fixture(params=MACHINES, scope='module')
def case(request):
    machine = load(request.param)
    poses = sample(machine, 20, np.random.default_rng(3))
    model = model_of(machine.kinematics, BUILT)
    errors = np.array([p.tolerance for p in model.parameters]) / 3
    values = errors * np.random.default_rng(4).standard_normal(len(errors))
    return (
        request.param,
        machine.kinematics,
        model,
        values,
        machine.kinematics.inverse(poses),
        poses,
    )


def test_without_errors_the_model_stands_where_the_machine_does(case):
    _, _, model, values, joints, poses = case
    found = model.predict(0 * values, joints, poses.moved(np.full(6, 1e-3)))
    assert np.abs(poses.twist_to(found)).max() < 1e-9


def test_the_identified_machine_written_and_read_stands_where_the_model_does(case):
    name, _, model, values, joints, poses = case
    lines = ['geometry:', *geometry_lines(model.identified(values))]
    geometry = yaml.safe_load('\n'.join(lines))['geometry']
    file = read(name)
    built, _ = KINDS[file.kind].build(replace(file, geometry=geometry))
    told = model.predict(values, joints, poses)
    for k in range(len(joints)):
        pose = built.forward(joints[k] + model.joint_offsets(values), poses[k]).pose
        miss = told[k].twist_to(pose)
        assert np.abs(miss).max() < 3e-6


def test_slopes_are_what_differences_say(case):
    _, _, model, values, joints, poses = case
    here = model.predict(values, joints, poses)
    slopes = model.slopes(values, joints, here)
    assert slopes.shape == (20, 6, len(model.parameters))
    step = 1e-6
    for k in range(len(values)):
        change = np.zeros_like(values)
        change[k] = step
        ahead, behind = (model.predict(values + s * change, joints, here) for s in (1, -1))
        numeric = behind.twist_to(ahead) / (2 * step)
        assert np.abs(numeric - slopes[..., k]).max() < 1e-5 * (1 + np.abs(slopes[..., k]).max())


def test_slopes_of_the_device_are_what_differences_say(case):
    _, _, model, values, joints, poses = case
    frames = DeviceFrames(
        Pose.from_xyz_rpy([0.5, -0.2, 0.3], [0.3, -0.4, 2.0]),
        Pose.from_xyz_rpy([0.02, 0.01, 0.03], [0.1, 0.2, -0.5]),
    )
    at = np.random.default_rng(5).standard_normal(12) * 0.1
    own = model.slopes(values, joints, poses)
    slopes = frames.slopes(at, poses, own)
    step = 1e-6
    for k in range(12):
        change = np.zeros(12)
        change[k] = step
        ahead, behind = (frames.moved(at + s * change).seen(poses) for s in (1, -1))
        numeric = behind.twist_to(ahead) / (2 * step)
        assert np.abs(numeric - slopes[..., len(values) + k]).max() < 1e-7
    now = frames.moved(at)
    twist = own[:, :, 0]
    ahead, behind = (now.seen(poses.moved(s * step * twist)) for s in (1, -1))
    numeric = behind.twist_to(ahead) / (2 * step)
    assert np.abs(numeric - slopes[..., 0]).max() < 1e-6


def test_moving_all_of_the_base_moves_the_platform_alike_on_every_leg(case):
    """Names of what a measuring device in an unknown place cannot see: all six motions."""
    _, _, model, values, joints, poses = case
    here = model.predict(values, joints, poses)
    slopes = model.slopes(values, joints, here)
    for axis, name in enumerate('xyz'):
        shift = model.rigid_motions(values)[f'the anchors shifted together along {name}']
        np.testing.assert_allclose(slopes @ shift, np.tile(np.eye(6)[axis], (20, 1)), atol=1e-8)
        turn = model.rigid_motions(values)[f'the anchors turned together about {name}']
        about = np.cross(np.eye(3)[axis], here.position)
        twists = np.column_stack([about, np.tile(np.eye(3)[axis], (20, 1))])
        np.testing.assert_allclose(slopes @ turn, twists, atol=1e-7)


def test_joints_that_close_nowhere_are_refused(case):
    _, _, model, values, joints, poses = case
    values = values.copy()
    values[:18] += np.tile([0.5, 0.0, 0.0, -0.5, 0.0, 0.0], 3)
    with pytest.raises(NoSolution):
        model.predict(values, joints, poses)


def test_a_machine_that_is_no_platform_is_refused_in_words():
    with pytest.raises(InvalidInput, match='no model to identify for a SerialArm'):
        model_of(load('arm_6r').kinematics, BUILT)


def test_axes_are_written_where_the_planes_are_not_those_that_a_file_without_axes_has():
    upright = load('robocake').kinematics.geometry
    assert not any('crank_axes' in line for line in geometry_lines(upright))
    config = build(HexagonConfig, {**read('robocake').geometry, 'home_height_mm': -41.19})
    hanging = config.geometry()
    written = yaml.safe_load('\n'.join(['geometry:', *geometry_lines(hanging)]))['geometry']
    again = build(JointsConfig, written).geometry()
    np.testing.assert_allclose(again.normals, hanging.normals, atol=1e-6)
    np.testing.assert_allclose(again.ups, hanging.ups, atol=1e-6)
