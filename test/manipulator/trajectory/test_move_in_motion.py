import pickle

import numpy as np
import pytest

from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.errors import Refused
from manipulator.planning.plan import MotionState
from manipulator.planning.point_to_point import (
    coordinates,
    plan_line_move,
    plan_move_in_motion,
    state_of,
)
from manipulator.pose import Pose

LIMITS = load('robocake').motion


def random_pose(rng, reach=0.1, turn=2.5):
    return Pose(rng.uniform(-reach, reach, 3), so3.exp(rng.uniform(-turn, turn, 3) / np.sqrt(3)))


def random_state(rng):
    return MotionState(random_pose(rng), rng.uniform(-0.02, 0.02, 6), rng.uniform(-0.5, 0.5, 6))


def test_move_begins_with_the_state_and_ends_at_rest_at_the_goal():
    rng = np.random.default_rng(1)
    for _ in range(50):
        start, goal = random_state(rng), random_pose(rng)
        move = plan_move_in_motion(start, goal, LIMITS)
        first, last = move.at(0.0), move.at(move.duration)
        assert np.abs(start.pose.twist_to(first.pose)).max() < 1e-8
        np.testing.assert_allclose(first.twist, start.twist, atol=1e-9)
        np.testing.assert_allclose(first.acceleration, start.acceleration, atol=1e-5)
        assert np.abs(goal.twist_to(last.pose)).max() < 1e-8
        assert np.abs(last.twist).max() < 1e-7


def test_twist_and_acceleration_are_the_derivatives_of_the_pose():
    rng = np.random.default_rng(2)
    for _ in range(20):
        move = plan_move_in_motion(random_state(rng), random_pose(rng), LIMITS)
        t, h = rng.uniform(0.1, 0.9) * move.duration, 1e-5
        before, now, after = (move.at(t + k * h) for k in (-1, 0, 1))
        numeric = before.pose.twist_to(after.pose) / (2 * h)
        np.testing.assert_allclose(now.twist, numeric, atol=1e-5)
        numeric = (after.twist - before.twist) / (2 * h)
        np.testing.assert_allclose(now.acceleration, numeric, atol=0.05)


def test_a_start_faster_than_the_limits_is_braked_and_ends_at_the_goal():
    rng = np.random.default_rng(6)
    for _ in range(10):
        start, goal = random_state(rng), random_pose(rng)
        fast = MotionState(start.pose, 5.0 * start.twist, 5.0 * start.acceleration)
        move = plan_move_in_motion(fast, goal, LIMITS)
        states = move.at(np.linspace(0.0, move.duration, 20_001))
        h = move.duration / 20_000
        np.testing.assert_allclose(states.twist[0], fast.twist, atol=1e-9)
        steps = states.pose[:-1].twist_to(states.pose[1:])
        means = (states.twist[:-1] + states.twist[1:]) / 2
        np.testing.assert_allclose(steps / h, means, atol=1e-4)
        assert np.abs(goal.twist_to(states.pose[-1])).max() < 1e-8


def test_a_plan_is_made_of_numbers_and_keeps_no_object_of_ruckig():
    rng = np.random.default_rng(7)
    state, goal = random_state(rng), random_pose(rng)
    for move in (
        plan_move_in_motion(state, goal, LIMITS),
        plan_line_move(state.pose, goal, LIMITS),
    ):
        copy = pickle.loads(pickle.dumps(move))
        np.testing.assert_array_equal(copy.at(0.1).twist, move.at(0.1).twist)


def test_slowdown_stretches_time_and_keeps_the_path():
    rng = np.random.default_rng(3)
    for _ in range(10):
        start, goal = MotionState.at_rest(random_pose(rng)), random_pose(rng)
        move, slow = (
            plan_move_in_motion(start, goal, LIMITS),
            plan_move_in_motion(start, goal, LIMITS, 2.0),
        )
        np.testing.assert_allclose(slow.duration, 2.0 * move.duration, rtol=1e-6)
        same = move.at(0.3 * move.duration).pose.twist_to(slow.at(0.3 * slow.duration).pose)
        assert np.abs(same).max() < 1e-7


def test_coordinates_that_change_fast_make_the_state_that_differences_give():
    rng = np.random.default_rng(4)
    for _ in range(20):
        x, v, a = rng.uniform(-1.0, 1.0, (3, 6))
        times = np.array([-1e-4, 0.0, 1e-4])[:, None]
        moved, rates = x + v * times + a * times**2 / 2, v + a * times
        state = state_of(moved, rates, np.tile(a, (3, 1)), np.eye(3))
        step = state.pose[0].twist_to(state.pose[2]) / 2e-4
        np.testing.assert_allclose(state.twist[1], step, atol=1e-6)
        change = (state.twist[2] - state.twist[0]) / 2e-4
        np.testing.assert_allclose(state.acceleration[1], change, atol=1e-6)
        one = MotionState(state.pose[1], state.twist[1], state.acceleration[1])
        np.testing.assert_allclose(coordinates(one, np.eye(3)), (x, v, a), atol=1e-9)


@pytest.mark.parametrize(
    ('slowdown', 'reason'),
    [(1e3, ': it would take too long'), (1e6, r' \(ruckig: error in step 1, dof')],
)
def test_a_move_that_is_too_slow_to_be_calculated_is_refused(slowdown, reason):
    moving = MotionState(Pose.identity(), np.full(6, 0.05), np.zeros(6))
    goal = Pose(np.array([0.01, 0.0, 0.0]), np.eye(3))
    with pytest.raises(Refused, match=f'no jerk-limited move was found{reason}'):
        plan_move_in_motion(moving, goal, load('ur5').motion, slowdown)
