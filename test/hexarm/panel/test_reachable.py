"""The ranges of the sliders, against what the limits say."""

import numpy as np
import pytest

from hexarm.machines import load
from hexarm.panel.reachable import (
    bounds,
    coordinate_twists,
    coordinates,
    pose_at,
    reachable_ranges,
)
from manipulator.analysis.free_paths import admits
from manipulator.pose import Pose

PLATFORMS = ['robocake', 'stewart_6_3']


def moved(values, axis, change):
    return pose_at(values + change * np.eye(6)[axis])


@pytest.mark.parametrize('axis', range(6))
def test_a_coordinate_alone_is_a_twist_about_a_fixed_axis(axis):
    values = np.array([0.1, -0.2, 0.3, 0.4, -0.5, 0.6])
    twist = coordinate_twists(pose_at(values))[axis]
    there, by_twist = moved(values, axis, 0.3), pose_at(values).moved(0.3 * twist)
    np.testing.assert_allclose(by_twist.position, there.position, atol=1e-12)
    np.testing.assert_allclose(by_twist.rotation, there.rotation, atol=1e-12)


@pytest.mark.parametrize('name', PLATFORMS)
def test_just_within_the_range_is_admitted_and_just_beyond_is_not(name):
    machine = load(name)
    values = coordinates(machine.kinematics.home) + np.array(
        [1e-3, -2e-3, 1e-3, 0.02, 0.03, -0.02]
    )
    ranges = reachable_ranges(machine, pose_at(values))
    for axis, (low, high) in enumerate(ranges):
        for end in (low, high):
            inside, outside = (moved(values, axis, part * end) for part in (0.999, 1.001))
            assert admits(machine, inside[None])[0]
            assert not admits(machine, outside[None])[0]


def test_out_of_reach_there_is_no_range():
    machine = load('robocake')
    far = Pose.from_xyz_rpy((0.05, 0.0, 0.041))
    assert not reachable_ranges(machine, far).any()


@pytest.mark.parametrize('name', [*PLATFORMS, 'arm_6r', 'ur5'])
def test_home_lies_within_the_bounds(name):
    machine = load(name)
    home = coordinates(machine.kinematics.home)
    low, high = bounds(machine).T
    assert (low <= home).all()
    assert (home <= high).all()


def test_angles_are_reported_within_half_a_turn_of_others():
    pose = Pose.from_xyz_rpy((0.0, 0.0, 0.1), (-3.1, 0.0, 0.2))
    near = np.array([0.0, 0.0, 0.0, 3.1, 0.0, 6.3])
    expected = [0.0, 0.0, 0.1, 2 * np.pi - 3.1, 0.0, 0.2 + 2 * np.pi]
    np.testing.assert_allclose(coordinates(pose, near), expected, atol=1e-12)
