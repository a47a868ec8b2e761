"""Machines with known errors, found again; and what is said of what cannot be found."""

import functools

import numpy as np
import pytest

from hexarm.calibration.campaign import GOAL, NOISE, Campaign, some_frames, true_values
from manipulator.analysis.device_frames import DeviceFrames
from manipulator.analysis.identify import identify
from manipulator.analysis.measurements import Measurements, Noise
from manipulator.analysis.observability import (
    in_driving_order,
    model_directions,
    most_telling,
    what_is_not_seen,
)
from manipulator.errors import InvalidInput, NoSolution
from manipulator.pose import Pose
from sampling import enough

MACHINES = 4
UNSEEN = enough(100, 300)


@functools.cache  # pytest would make it again for each set of runs
def campaign_of(name):
    return Campaign.of(name, unseen=UNSEEN)


@pytest.fixture(params=['robocake', 'stewart_6_6'], scope='module')
def campaign(request):
    return campaign_of(request.param)


@pytest.fixture(params=[False, True], ids=['unknown frames', 'known frames'], scope='module')
def runs(campaign, request):
    return [campaign.run(seed, request.param) for seed in range(MACHINES)]


def test_after_40_poses_unseen_ones_are_known_to_50_micrometres_rms_an_axis(runs):
    after = np.sqrt(np.mean([run.after**2 for run in runs], axis=0))
    before = np.sqrt(np.mean([run.before**2 for run in runs], axis=0))
    assert after.max() <= GOAL
    assert before.min() > 3 * GOAL


def test_errors_are_as_large_as_the_covariance_predicts(runs):
    after = np.sqrt(np.mean([run.after**2 for run in runs]))
    law = np.sqrt(np.mean([run.law**2 for run in runs]))
    assert 0.6 < after / law < 1.6


def test_what_is_left_is_the_noise(runs):
    left = np.concatenate([run.found.after * NOISE.weights for run in runs])
    assert 0.7 < np.sqrt((left**2).mean()) < 1.0


def test_without_noise_every_unseen_pose_is_known(campaign):
    exact = Noise(1e-6, 1e-5)
    generator = np.random.default_rng(3)
    true, frames = true_values(campaign.model, generator), some_frames(generator)
    seen = frames.seen(campaign.model.predict(true, campaign.joints, campaign.poses))
    free = {p.group for p in campaign.model.parameters} | {'device', 'marker'}
    measured = Measurements(campaign.joints, seen)
    found = identify(campaign.model, measured, exact, campaign.poses, free)
    assert np.abs(found.after[:, :3]).max() < 1e-8


def test_combinations_that_no_measurement_sees_are_named(campaign):
    found = campaign.run(1).found
    motions = campaign.model.rigid_motions(found.model_values)
    dark = what_is_not_seen(
        found.slopes, found.parameters, found.deviations, model_directions(motions, found.is_free)
    )
    is_crank = len(campaign.model.parameters) == 60
    assert len(dark.unseen) == (10 if is_crank else 12)
    assert 'the anchors turned together about z, made up for by the device' in dark.unseen
    assert ('the anchors turned together about x, made up for by the device' in dark.unseen) != (
        is_crank
    )
    assert all('together' in name for name in dark.unseen)


def test_a_combination_that_nobody_expects_is_reported_by_its_terms(campaign):
    found = campaign.run(1, are_frames_known=True).found
    free = found.is_free.copy()
    slopes = found.slopes.copy()
    slopes[:, 1] = -slopes[:, 0]
    names = tuple(p for p, is_free in zip(found.parameters, free, strict=True) if is_free)
    dark = what_is_not_seen(slopes[:, free], names, found.deviations[free], {})
    assert dark.unseen == ('+1.0 anchor 1 x +1.0 anchor 1 y',) or dark.unseen == (
        '+1.0 anchor 1 y +1.0 anchor 1 x',
    )


def test_only_what_is_free_changes(campaign):
    generator = np.random.default_rng(2)
    true = true_values(campaign.model, generator)
    seen = campaign.model.predict(true, campaign.joints, campaign.poses)
    measured = Measurements(campaign.joints, seen)
    found = identify(campaign.model, measured, NOISE, campaign.poses, {'zeros'})
    changed = {p.group for p, v in zip(found.parameters, found.values, strict=True) if v != 0.0}
    assert changed == {'zeros'}


def test_a_group_that_there_is_not_is_named(campaign):
    measured = Measurements(campaign.joints, campaign.poses)
    with pytest.raises(InvalidInput, match="no parameters are called 'elbows'"):
        identify(campaign.model, measured, NOISE, campaign.poses, {'elbows'})


def test_frames_are_guessed_exactly_from_poses_that_are_exact(campaign):
    frames = some_frames(np.random.default_rng(8))
    guess = DeviceFrames.guessed(campaign.poses, frames.seen(campaign.poses))
    for reported, true in zip(vars(guess).values(), vars(frames).values(), strict=True):
        assert np.abs(true.twist_to(reported)).max() < 1e-9


def test_frames_cannot_be_guessed_from_poses_that_are_turned_alike(campaign):
    alike = Pose(campaign.poses.position, np.tile(np.eye(3), (len(campaign.joints), 1, 1)))
    with pytest.raises(NoSolution, match='one orientation'):
        DeviceFrames.guessed(alike, alike)


def test_chosen_poses_determine_more_than_any_that_are_taken_by_chance(campaign):
    model, generator = campaign.model, np.random.default_rng(1)
    own = model.slopes(np.zeros(len(model.parameters)), campaign.unseen_joints, campaign.unseen)
    rows = own * NOISE.weights[:, None] * np.array([p.tolerance for p in model.parameters])

    def information(chosen):
        some = rows[chosen].reshape(-1, rows.shape[2])
        return np.linalg.slogdet(np.eye(rows.shape[2]) + some.T @ some)[1]

    chosen = most_telling(rows, np.ones(rows.shape[2]), 15)
    assert len(set(chosen)) == 15
    by_chance = [information(generator.permutation(len(rows))[:15]) for _ in range(50)]
    assert information(chosen) > max(by_chance)


def test_driving_goes_to_the_nearest_next():
    ways = np.zeros((4, 6))
    ways[:, 0] = [3.0, 1.0, -0.5, 2.0]
    assert in_driving_order(ways) == [2, 1, 3, 0]
