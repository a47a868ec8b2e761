"""An arm whose joints are not where its file says, found again from 40 poses."""

import numpy as np
import pytest

from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.machine_model import machine_model, new_geometry
from hexarm.calibration.poses import telling_poses
from hexarm.machines import load
from manipulator.identification.device_frames import DeviceFrames
from manipulator.identification.identify import identify
from manipulator.identification.measurements import Measurements, Noise
from manipulator.identification.observability import model_directions, what_is_not_seen
from manipulator.pose import Pose

NOISE = Noise(1e-4, 1e-3)
BUILT = Tolerances(5e-4, np.radians(1.0))


@pytest.fixture(params=['arm_6r', 'ur5'], scope='module')
def case(request):
    machine = load(request.param)
    model = machine_model(machine.kinematics, BUILT)
    joints, poses = telling_poses(machine, model, NOISE, 40)
    return machine, model, joints, poses


def test_proposed_poses_are_within_the_joint_ranges_and_above_the_base(case):
    machine, _, joints, poses = case
    limits = machine.kinematics.limits
    assert ((limits.low < joints) & (joints < limits.high)).all()
    assert (poses.position[:, 2] > 0.0).all()


def test_zeros_are_found_but_for_the_first_and_last_which_the_frames_make_up_for(case):
    _, model, joints, poses = case
    generator = np.random.default_rng(5)
    true = np.radians(generator.uniform(-1, 1, 6))
    frames = DeviceFrames(
        Pose.from_xyz_rpy([1.0, 0.5, -0.2], [0.1, 0.2, 2.0]),
        Pose.from_xyz_rpy([0.0, 0.02, 0.05], [0.3, 0.0, -1.0]),
    )
    seen = frames.seen(model.predict(true, joints, poses))
    seen = seen.moved(generator.standard_normal((len(joints), 6)) / NOISE.weights)
    free = {'zeros', 'device', 'marker'}
    found = identify(model, Measurements(joints, seen), NOISE, poses, free)
    assert np.abs(found.model_values - true)[1:5].max() < np.radians(0.05)
    assert np.abs(true)[1:5].max() > np.radians(0.5)
    dark = what_is_not_seen(
        found.slopes,
        found.parameters,
        found.deviations,
        model_directions(model.rigid_motions(found.model_values), found.is_free),
    )
    assert len(dark.unseen) == 2
    assert 'joint 1' in dark.unseen[0]
    assert dark.unseen[0].endswith('made up for by the device')
    assert 'joint 6' in dark.unseen[1]
    assert dark.unseen[1].endswith('made up for by the marker')


def test_all_that_is_found_of_an_arm_stands_in_its_servos(case):
    assert new_geometry(case[1], np.zeros(6)) == []
