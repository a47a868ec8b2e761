"""Paths checked by what they are for: near the polyline, at every pose, smooth."""

import numpy as np
import pytest

from manipulator import rotation as so3
from manipulator.errors import InvalidInput
from manipulator.planning.path import Path, Tolerance, arc, line, path_along, path_in_time
from manipulator.pose import Pose
from sampling import enough

TOLERANCE = Tolerance(1e-4, np.radians(0.1))
TURN_LENGTH = 0.05


def zigzag(seed, count=12, step=0.005, turn=0.1):
    rng = np.random.default_rng(seed)
    return Pose(
        np.cumsum(rng.uniform(-step, step, (count, 3)), axis=0),
        so3.exp(rng.uniform(-turn, turn, (count, 3))),
    )


def distance_to_polyline(points, corners):
    start, way = corners[:-1], np.diff(corners, axis=0)
    share = np.einsum('psi,si->ps', points[:, None] - start, way) / (way**2).sum(axis=1)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * way
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def turn_to_polyline(rotations, corners):
    steps = np.linspace(0.0, 1.0, 200)
    ways = so3.log(corners[1:] @ np.swapaxes(corners[:-1], 1, 2))
    on = so3.exp(steps[:, None, None] * ways) @ corners[:-1]
    on = on.reshape(-1, 3, 3)
    chord = np.linalg.norm(rotations[:, None] - on, axis=(2, 3)).min(axis=1)
    return chord / np.sqrt(2)


@pytest.mark.parametrize('seed', range(5))
def test_contour_stays_within_the_tolerance_of_the_polyline(seed):
    poses = zigzag(seed)
    path = path_along(poses, TOLERANCE, TURN_LENGTH)
    on = path.at(np.linspace(0.0, path.marks[-1], enough(300, 3000))).pose
    distance = distance_to_polyline(on.position, poses.position)
    assert distance.max() <= TOLERANCE.distance
    assert distance.max() > TOLERANCE.distance / 10
    assert turn_to_polyline(on.rotation, poses.rotation).max() <= TOLERANCE.turn + 2e-4


@pytest.mark.parametrize('seed', range(5))
def test_every_pose_is_passed_within_the_tolerance_and_the_ends_exactly(seed):
    poses = zigzag(seed)
    path = path_along(poses, TOLERANCE, TURN_LENGTH)
    missed = path.at(path.marks).pose.twist_to(poses)
    assert np.linalg.norm(missed[:, :3], axis=1).max() <= TOLERANCE.distance
    assert np.linalg.norm(missed[:, 3:], axis=1).max() <= TOLERANCE.turn
    assert np.abs(missed[[0, -1]]).max() < 1e-12


def test_derivatives_are_those_of_the_pose_and_the_tangent_never_jumps():
    path, h = path_along(zigzag(7), TOLERANCE, TURN_LENGTH), 1e-7
    edges = np.concatenate([path.marks[1:-1] + k * path.blends[1:-1] for k in (-1, 0, 1)])
    s = np.random.default_rng(0).uniform(2 * h, path.marks[-1] - 2 * h, 500)
    s = s[np.abs(s[:, None] - edges).min(axis=1) > 2 * h]
    before, now, after = (path.at(s + k * h) for k in (-1, 0, 1))
    slope = before.pose.twist_to(after.pose) / (2 * h)
    np.testing.assert_allclose(now.twist, slope, atol=2e-6)
    bend = (after.twist - before.twist) / (2 * h)
    np.testing.assert_allclose(now.acceleration, bend, atol=1e-3 * np.abs(bend).max())
    jump = path.at(edges + h).twist - path.at(edges - h).twist
    steepest = np.abs(path.at(np.linspace(0, path.marks[-1], 9000)).acceleration).max()
    assert np.abs(jump).max() <= 4 * h * steepest


def test_dense_circle_is_round_and_not_a_polygon():
    poses = arc(Pose.from_xyz_rpy((0.01, 0, 0)), (0, 0, 0), (0, 0, 1), 2 * np.pi, sagitta=3e-6)
    path = path_along(poses, TOLERANCE, TURN_LENGTH)
    state = path.at(np.linspace(path.marks[2], path.marks[-3], 2000))
    radius = np.linalg.norm(state.pose.position, axis=1)
    assert np.ptp(radius) < 4e-6
    curvature = np.linalg.norm(state.acceleration, axis=1)
    assert curvature.min() > 0.95 / 0.01
    assert curvature.max() < 1.05 / 0.01


def test_repeated_poses_are_dropped_and_the_others_keep_their_numbers():
    corners = [(0, 0, 0), (0, 0, 0), (0.01, 0, 0), (0.01, 0, 1e-7), (0.01, 0.01, 0)]
    path = path_along(Pose(np.array(corners, dtype=float), np.eye(3)), TOLERANCE, TURN_LENGTH)
    assert path.numbers == (1, 3, 5)
    assert path.metres(path.marks[-1]) == pytest.approx(0.02)
    assert 'pose 3, 0.01 m' in path.where(path.marks[1])


def test_one_pose_however_often_is_no_path():
    pose = Pose.from_xyz_rpy((0.01, 0.02, 0.03), (0.1, 0.2, 0.3))
    for count in (1, 2, 50):
        same = Pose(np.tile(pose.position, (count, 1)), np.tile(pose.rotation, (count, 1, 1)))
        only = path_along(same, TOLERANCE, TURN_LENGTH)
        assert isinstance(only, Pose)
        assert np.abs(only.twist_to(pose)).max() < 1e-12


def test_turn_in_place_has_a_length_by_which_it_can_be_timed():
    poses = Pose(np.zeros((2, 3)), so3.from_rpy([(0, 0, 0), (0, 0, 0.4)]))
    path = path_along(poses, TOLERANCE, TURN_LENGTH)
    assert isinstance(path, Path)
    assert path.marks[-1] == pytest.approx(0.4 * TURN_LENGTH)
    assert path.metres(path.marks[-1]) == 0.0


def test_stamped_path_is_at_every_pose_at_its_stamp():
    poses, stamps = zigzag(3), 100.0 + np.cumsum(np.linspace(0.1, 0.5, 12))
    path = path_in_time(poses, stamps, TOLERANCE)
    missed = path.at(stamps - stamps[0]).pose.twist_to(poses)
    assert np.linalg.norm(missed[:, :3], axis=1).max() <= TOLERANCE.distance


def test_line_has_its_two_ends():
    start, goal = Pose.from_xyz_rpy((0, 0, 0)), Pose.from_xyz_rpy((0, 0, 1), (0.1, 0, 0))
    ends = line(start, goal)
    assert np.abs(ends[0].twist_to(start)).max() == 0.0
    assert np.abs(ends[1].twist_to(goal)).max() < 1e-12


def test_arc_keeps_its_radius_its_sagitta_and_its_end():
    start = Pose.from_xyz_rpy((0.05, 0.0, 0.02), (0.1, 0.2, 0.3))
    centre, axis = np.array([0.0, 0.0, 0.0]), np.array([0.0, 0.0, 2.0])
    poses = arc(start, centre, axis, 3.0, is_turning=True, sagitta=1e-5)
    np.testing.assert_allclose(np.linalg.norm(poses.position[:, :2], axis=1), 0.05, atol=1e-12)
    middles = (poses.position[1:] + poses.position[:-1]) / 2
    assert 0.05 - np.linalg.norm(middles[:, :2], axis=1).min() <= 1e-5
    turned = so3.exp([0.0, 0.0, 3.0])
    np.testing.assert_allclose(poses.position[-1], turned @ start.position, atol=1e-12)
    np.testing.assert_allclose(poses.rotation[-1], turned @ start.rotation, atol=1e-12)
    kept = arc(start, centre, axis, 3.0)
    np.testing.assert_allclose(kept.rotation[-1], start.rotation)


@pytest.mark.parametrize(
    ('axis', 'angle', 'sagitta'),
    [((0, 0, 0), 1.0, 1e-5), ((0, 0, float('nan')), 1.0, 1e-5), ((0, 0, 1), 1e9, 1e-5)],
)
def test_arc_that_is_none_or_too_long_is_refused(axis, angle, sagitta):
    with pytest.raises(InvalidInput, match='arc'):
        arc(Pose.from_xyz_rpy((0.05, 0, 0)), (0, 0, 0), axis, angle, sagitta=sagitta)


def test_a_place_on_a_path_is_at_a_pose_or_after_it():
    corners = np.array([[0, 0, 0], [0.01, 0, 0], [0.01, 0.02, 0]], dtype=float)
    path = path_along(Pose(corners, np.stack([np.eye(3)] * 3)), TOLERANCE, TURN_LENGTH)
    assert path.where(0.0) == 'at pose 1, 0 m along the path'
    assert path.where(0.005) == 'after pose 1, 0.005 m along the path'
    assert path.where(0.01) == 'at pose 2, 0.01 m along the path'
    assert path.where(0.025) == 'after pose 2, 0.025 m along the path'
    assert path.where(0.03) == 'at pose 3, 0.03 m along the path'
