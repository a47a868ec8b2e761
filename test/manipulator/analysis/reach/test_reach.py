import numpy as np
import pytest

from hexapod_control.workspace import sample
from manipulator import rotation as so3
from manipulator.analysis.free_paths import is_connected, is_free
from manipulator.analysis.reach import reach, smallest_margins
from manipulator.analysis.readings import displaced, distance
from manipulator.pose import Pose


def test_home_is_reachable_and_all_margins_are_positive(machine):
    found = reach(machine, machine.kinematics.home)
    assert found.is_reachable
    assert found.reason == ''
    assert min(r.margin for r in found.limits) > 0.0
    assert found.broken == ()


def test_the_nearest_limit_comes_first(machine):
    distances = [r.distance for r in reach(machine, machine.kinematics.home).limits]
    assert distances == sorted(distances)


def test_a_leg_that_does_not_close_reports_by_how_much_its_rod_is_too_short(robocake):
    pose = robocake.kinematics.home.moved([0.03, 0, 0, 0, 0, 0])
    found = reach(robocake, pose)
    assert not found.is_reachable
    worst = found.broken[0]
    assert worst.quantity == 'rod shortfall'
    g = robocake.kinematics.geometry
    leg = int(worst.owner[-1]) - 1
    joint = pose.transform(g.platform_points)[leg]
    angles = np.linspace(0, 2 * np.pi, 100_001)[:, None]
    circle = g.crank_centres[leg] + g.crank_lengths[leg] * (
        np.cos(angles) * g.tangents[leg] + np.sin(angles) * g.ups[leg]
    )
    shortest = np.linalg.norm(joint - circle, axis=1).min()
    assert worst.value == pytest.approx(shortest - g.rod_lengths[leg], abs=1e-8)
    assert worst.margin == -worst.value
    assert f'leg {leg + 1}: rod too short by' in found.reason


def test_margins_of_home_are_the_smallest_of_their_quantity(machine):
    margins = {}
    for limit in reach(machine, machine.kinematics.home).limits:
        margins[limit.quantity] = min(limit.margin, margins.get(limit.quantity, np.inf))
    for limit in smallest_margins(machine):
        assert limit.margin == margins[limit.quantity]


def test_values_that_do_not_exist_are_left_out(robocake):
    found = reach(robocake, robocake.kinematics.home.moved([0.03, 0, 0, 0, 0, 0]))
    assert all(np.isfinite(r.value) for r in found.limits)
    assert 'singularity margin' not in {r.quantity for r in found.limits}


def test_an_arm_out_of_reach_has_a_reason_and_no_readings(arm):
    found = reach(arm, arm.kinematics.home.moved([3.0, 0, 0, 0, 0, 0]))
    assert not found.is_reachable
    assert 'reach' in found.reason
    assert found.limits == ()


def test_the_distance_to_a_limit_is_where_it_is_met_to_first_order(platform):
    """Going down the nearest limit's slope, it is met after about the distance stated."""
    home = platform.kinematics.home
    near = displaced(platform, home, np.array([0.004, 0.003, 0.008, 0.002, 0.001, 0.003]))
    first = reach(platform, near).limits[0]
    generator = np.random.default_rng(4)
    ways = generator.standard_normal((4000, 6))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    step = 0.05 * first.distance

    def value(pose):
        limits = reach(platform, pose).limits
        return next(
            r for r in limits if (r.quantity, r.owner) == (first.quantity, first.owner)
        ).margin

    steepest = max(first.margin - value(displaced(platform, near, step * w)) for w in ways[:300])
    assert steepest / step <= first.margin / first.distance * 1.1
    assert steepest / step >= 0.6 * first.margin / first.distance


def test_samples_of_the_workspace_are_reachable(platform):
    poses = sample(platform, 60, np.random.default_rng(2))
    for k in range(60):
        assert reach(platform, poses[k]).is_reachable


def test_reach_agrees_with_the_constraints_everywhere(platform):
    generator = np.random.default_rng(3)
    home, length = platform.kinematics.home, platform.kinematics.characteristic_length
    steps = generator.standard_normal((150, 6)) * generator.uniform(0.02, 0.5, (150, 1))
    poses = displaced(platform, home, steps * length)
    joints = platform.kinematics.inverse_or_nan(poses)
    admitted = platform.constraints.admits(poses, joints)
    assert 5 < admitted.sum() < 145
    for k in range(150):
        found = reach(platform, poses[k])
        assert found.is_admitted == admitted[k]
        assert (found.reason == '') == found.is_reachable
        if not admitted[k]:
            assert found.broken or not np.isfinite(joints[k]).all()


def test_a_pose_beyond_a_forward_singularity_is_admitted_but_not_connected(robocake):
    """Found by search: all limits kept, det J of the other sign than at home."""
    kinematics = robocake.kinematics
    generator = np.random.default_rng(2)
    low, high = [-0.03, -0.03, 0.0234], [0.03, 0.03, 0.075]
    poses = Pose(
        generator.uniform(low, high, (200_000, 3)),
        so3.exp(generator.uniform(-0.7, 0.7, (200_000, 3))),
    )
    joints = kinematics.inverse_or_nan(poses)
    inside = np.isfinite(joints).all(axis=1)
    inside[inside] = robocake.constraints.admits(poses[inside], joints[inside])
    poses, joints = poses[inside], joints[inside]
    sides = np.linalg.det(kinematics.leg_jacobian(poses, joints)) * kinematics.home_side
    beyond = np.flatnonzero(sides < 0.0)
    assert beyond.size
    for k in beyond:
        found = reach(robocake, poses[k])
        assert found.is_admitted
        assert not found.is_connected
        assert 'no path from home' in found.reason
    for k in np.flatnonzero(sides > 0.0)[:10]:
        assert is_connected(robocake, poses[k])


def test_a_path_through_what_is_forbidden_is_not_free(robocake):
    left, right = (robocake.kinematics.home.moved([x, 0, 0, 0, 0, 0]) for x in (-0.01, 0.03))
    assert is_free(robocake, left, robocake.kinematics.home)
    assert not is_free(robocake, left, right)
    assert distance(robocake, left, right) == pytest.approx(0.04)
