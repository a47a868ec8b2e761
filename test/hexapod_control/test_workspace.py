import dataclasses

import numpy as np
import pytest

from hexapod_control.workspace import axis_range, sample
from manipulator.analysis.free_paths import admits
from manipulator.limits.constraints import Constraints
from manipulator.pose import Pose


@pytest.fixture(scope='module')
def cloud(robocake):
    return sample(robocake, 2000, np.random.default_rng(5))


@pytest.fixture(scope='module')
def free_reach(robocake):
    """The body's lid alone: what the paper's ranges and their check are about."""
    lid = tuple(x for x in robocake.constraints.limits if x.quantity == 'platform height')
    return dataclasses.replace(robocake, constraints=Constraints(lid))


@pytest.mark.parametrize(
    ('axis', 'low', 'high', 'tolerance'),
    [
        (0, -15.62e-3, 15.62e-3, 1e-5),
        (1, -15.19e-3, 19.68e-3, 1e-5),
        (2, -17.8e-3, 17.90e-3, 1.1e-5),
        (3, -0.232, 0.347, 1e-3),
        (4, -0.240, 0.240, 1e-3),
        (5, -0.206, 0.206, 1e-3),
    ],
)
def test_free_reach_along_each_axis_is_the_papers(free_reach, axis, low, high, tolerance):
    assert axis_range(free_reach, axis) == pytest.approx((low, high), abs=tolerance)


def test_limits_cost_no_reach_along_an_axis_but_where_the_margin_falls(robocake, free_reach):
    for axis in (0, 1, 2, 4, 5):
        expected = pytest.approx(axis_range(free_reach, axis))
        assert axis_range(robocake, axis) == expected
    low, high = axis_range(robocake, 3)
    assert low == pytest.approx(-0.232, abs=1e-3)
    assert 0.29 < high < 0.347


def test_the_bound_found_is_the_last_admitted_pose(robocake):
    for offset, expected in ((0.0, True), (1e-6, False)):
        x = axis_range(robocake, 0)[1] + offset
        pose = Pose.from_xyz_rpy([[x, 0.0, 0.04119]])
        assert admits(robocake, pose)[0] == expected


def test_samples_keep_all_limits(robocake, cloud):
    assert cloud.position.shape == (2000, 3)
    assert admits(robocake, cloud).all()


def test_samples_fill_the_workspace(robocake, cloud):
    for axis in range(3):
        low, high = axis_range(robocake, axis)
        spread = cloud.position[:, axis] - robocake.kinematics.home.position[axis]
        assert spread.max() > 0.55 * high
        assert spread.min() < 0.55 * low
    assert np.abs(cloud.rpy).max(axis=0) == pytest.approx(0.25, abs=0.12)


def test_samples_share_the_symmetry_of_the_machine(cloud):
    """Turned by 120° about z the machine is itself, so x and y centre on zero, alike spread."""
    x, y = cloud.position[:, 0], cloud.position[:, 1]
    assert np.abs([x.mean(), y.mean()]).max() < 1.5e-3
    assert x.std() == pytest.approx(y.std(), rel=0.1)


def test_samples_stay_on_homes_side_of_forward_singularities(robocake, cloud):
    hexapod = robocake.kinematics
    sides = np.linalg.det(hexapod.leg_jacobian(cloud, hexapod.inverse(cloud)))
    assert (sides * hexapod.home_side > 0).all()


def test_walkers_do_not_leave_the_part_that_holds_home(robocake):
    """Two admitted slabs apart: only home's is visited."""

    class TwoSlabs:
        quantity, unit, owners = 'slab', '', ('',)
        low, high = np.array([0.0]), np.array([np.inf])

        def values(self, pose, joints):
            return np.abs(pose.position[..., :1]) - 0.002 * (pose.position[..., :1] > -0.001)

    gap = TwoSlabs()
    limits = Constraints((*robocake.constraints.limits, gap))
    hexapod = dataclasses.replace(robocake.kinematics)
    object.__setattr__(hexapod, 'home', hexapod.home.moved([0.004, 0, 0, 0, 0, 0]))
    machine = dataclasses.replace(robocake, kinematics=hexapod, constraints=limits)
    visited = sample(machine, 300, np.random.default_rng(1)).position[:, 0]
    assert visited.min() >= 0.002


def test_the_same_seed_gives_the_same_poses(robocake):
    a, b = (sample(robocake, 20, np.random.default_rng(9)) for _ in range(2))
    np.testing.assert_array_equal(a.position, b.position)
