"""The orientation of goals and paths that are points alone, by definition."""

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import Refused
from manipulator.planning.orientation import Orientation, OrientationRule
from manipulator.planning.path import Tolerance, arc
from manipulator.planning.path_timing import PathRequest, plan_path
from manipulator.pose import Pose

DT = 0.01
START = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (3.0, 0.2, 0.7))
GOAL = Pose.from_xyz_rpy((0.2, 0.1, 0.4), (0.3, 0.1, 0.2))


def approach(pose):
    return pose.rotation[..., :, 2]


def angle(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), (a * b).sum(axis=-1))


@pytest.mark.parametrize('orientation', list(Orientation))
def test_the_goals_position_is_kept(orientation):
    rule = OrientationRule(orientation, np.array([0.0, 0.0, 0.9]))
    np.testing.assert_array_equal(rule.applied(GOAL, START).position, GOAL.position)


def test_a_given_orientation_is_that_of_the_goal():
    np.testing.assert_array_equal(OrientationRule().applied(GOAL, START).rotation, GOAL.rotation)


def test_a_held_orientation_is_that_of_the_start():
    held = OrientationRule(Orientation.HOLD).applied(GOAL, START)
    np.testing.assert_array_equal(held.rotation, START.rotation)


def test_parallel_takes_the_nearest_axis_by_the_shortest_turn():
    turned = OrientationRule(Orientation.PARALLEL).applied(GOAL, START)
    np.testing.assert_allclose(approach(turned), [0.0, 0.0, -1.0], atol=1e-12)
    turn = np.linalg.norm(START.twist_to(turned)[3:])
    assert turn == pytest.approx(angle(approach(START), np.array([0.0, 0.0, -1.0])))


def test_look_at_points_at_the_point_by_the_shortest_turn():
    point = np.array([0.5, -0.1, 0.2])
    turned = OrientationRule(Orientation.LOOK_AT, point).applied(GOAL, START)
    sight = (point - GOAL.position) / np.linalg.norm(point - GOAL.position)
    np.testing.assert_allclose(approach(turned), sight, atol=1e-12)
    turn = np.linalg.norm(START.twist_to(turned)[3:])
    assert turn == pytest.approx(angle(approach(START), sight))


def test_look_at_without_a_point_or_too_near_to_it_is_refused():
    with pytest.raises(Refused, match=r'no point was given yet \(topic look_at\)'):
        OrientationRule(Orientation.LOOK_AT).applied(GOAL, START)
    near = OrientationRule(Orientation.LOOK_AT, GOAL.position + 0.001)
    with pytest.raises(Refused, match=r'is 0\.001732 m from the tool, needs at least 0\.02 m'):
        near.applied(GOAL, START)
    beside = GOAL.position + np.array([0.1, 0.0, 0.0])
    row = Pose(np.array([[0.0, 0.0, 0.0], beside, 2 * GOAL.position - beside]), np.eye(3))
    with pytest.raises(Refused, match=r'^pose 2 and from there: the look-at point is'):
        near.along(row, START)


def test_a_path_of_two_points_looks_at_the_point_all_along_and_names_the_senders_poses():
    machine = load('arm_6r_stepper')
    home = machine.kinematics.home
    ends = home.position + np.array([[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]])
    point = home.position + np.array([0.0, 0.05, -0.3])
    rule = OrientationRule(Orientation.LOOK_AT, point)
    request = PathRequest(Pose(ends, np.eye(3)), 0.1, Tolerance()).oriented(rule, home)
    assert set(request.numbers) == {1, 2}
    near = machine.kinematics.inverse(request.poses[0], machine.kinematics.inverse(home))
    path = plan_path(machine, request, near, DT)
    poses = path.at(np.linspace(0.0, path.duration, 400)).pose
    off = angle(approach(poses), point - poses.position)
    assert off.max() < np.radians(0.1)
    assert np.abs(poses.position[:, 1:] - home.position[1:]).max() < 1e-9


@pytest.mark.parametrize('orientation', [Orientation.HOLD, Orientation.PARALLEL])
def test_along_a_path_of_points_the_orientation_is_kept(orientation):
    row = arc(GOAL, (0.2, 0.15, 0.4), (0, 0, 1), np.pi, is_turning=True)
    rule = OrientationRule(orientation)
    poses, places = rule.along(row, START)
    np.testing.assert_array_equal(places, np.arange(len(row.position)))
    np.testing.assert_array_equal(poses.position, row.position)
    same = np.broadcast_to(rule.applied(GOAL, START).rotation, poses.rotation.shape)
    np.testing.assert_allclose(poses.rotation, same, atol=1e-12)


def test_stamps_of_a_path_that_looks_at_a_point_are_those_given():
    rule = OrientationRule(Orientation.LOOK_AT, np.array([0.0, 0.0, -0.2]))
    row = Pose(np.array([[-0.2, 0, 0], [0.2, 0, 0], [0.2, 0, 0], [0.2, 0.2, 0]]), np.eye(3))
    request = PathRequest(row, 0.1, Tolerance(), np.array([0.0, 2.0, 3.0, 4.0]))
    made = request.oriented(rule, START)
    for stamp, position in zip(request.stamps, row.position, strict=True):
        (k,) = np.flatnonzero(made.stamps == stamp)
        np.testing.assert_array_equal(made.poses.position[k], position)
    assert (np.diff(made.stamps) > 0.0).all()


def test_a_path_that_turns_too_often_is_refused_before_it_costs_time():
    there_and_back = np.tile([[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]], (500, 1))
    rule = OrientationRule(Orientation.LOOK_AT, np.array([0.0, 0.0, -0.05]))
    with pytest.raises(Refused, match=r'pose \d+: looking at the point takes more than 10,000'):
        rule.along(Pose(there_and_back, np.eye(3)), START)
