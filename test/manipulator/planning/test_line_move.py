import numpy as np
import pytest

from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.errors import Refused
from manipulator.motion_limits import Derivatives, JointDerivatives, MotionLimits
from manipulator.planning.check import check_plan
from manipulator.planning.plan import MotionState
from manipulator.planning.point_to_point import plan_line_move, plan_move_in_motion
from manipulator.pose import Pose

LIMITS = load('robocake').motion


def random_pose(rng):
    return Pose(rng.uniform(-0.1, 0.1, 3), so3.exp(rng.uniform(-1.4, 1.4, 3)))


def test_move_is_straight_turns_about_one_axis_and_ends_at_the_goal():
    rng = np.random.default_rng(3)
    start, goal = random_pose(rng), random_pose(rng)
    move = plan_line_move(start, goal, LIMITS)
    states = move.at(np.linspace(0.0, move.duration, 50))
    whole = start.twist_to(goal)
    for pose in (states.pose[i] for i in range(50)):
        part = start.twist_to(pose)
        assert np.linalg.norm(np.cross(part[:3], whole[:3])) < 1e-12
        assert np.linalg.norm(np.cross(part[3:], whole[3:])) < 1e-12
    assert np.abs(states.pose[49].twist_to(goal)).max() < 1e-8


def test_speed_acceleration_and_jerk_reach_a_limit_and_pass_none():
    rng = np.random.default_rng(4)
    for _ in range(20):
        move = plan_line_move(random_pose(rng), random_pose(rng), LIMITS)
        states = move.at(np.linspace(0.0, move.duration, 2000))
        ratios = [
            np.linalg.norm(part[:, axes], axis=1).max() / bound
            for part, name in ((states.twist, 'speed'), (states.acceleration, 'acceleration'))
            for axes, bound in (
                (slice(0, 3), getattr(LIMITS.linear, name)),
                (slice(3, 6), getattr(LIMITS.angular, name)),
            )
        ]
        assert max(ratios) == pytest.approx(1.0, abs=1e-6)


def test_twist_is_the_derivative_of_the_pose():
    rng = np.random.default_rng(5)
    move = plan_line_move(random_pose(rng), random_pose(rng), LIMITS)
    t, h = 0.4 * move.duration, 1e-5
    before, now, after = (move.at(t + k * h) for k in (-1, 0, 1))
    np.testing.assert_allclose(now.twist, before.pose.twist_to(after.pose) / (2 * h), atol=1e-6)
    np.testing.assert_allclose(now.acceleration, (after.twist - before.twist) / (2 * h), atol=1e-2)


def test_slowdown_stretches_time_and_keeps_the_path():
    rng = np.random.default_rng(6)
    start, goal = random_pose(rng), random_pose(rng)
    move, slow = plan_line_move(start, goal, LIMITS), plan_line_move(start, goal, LIMITS, 2.0)
    assert slow.duration == pytest.approx(2.0 * move.duration, rel=1e-6)
    same = move.at(0.3 * move.duration).pose.twist_to(slow.at(0.3 * slow.duration).pose)
    assert np.abs(same).max() < 1e-7


def test_goal_where_it_stands_is_a_move_within_a_tick():
    pose = random_pose(np.random.default_rng(7))
    assert plan_line_move(pose, pose, LIMITS).duration < 0.01


def test_a_move_that_ruckig_fails_at_is_refused():
    """At rest, but for rounding: from a stream of goals that ended."""
    x, y = 0.009514767606886248, 2.171702954699028e-13
    goal = Pose([x, y, 0.346090004968434], np.eye(3))
    twist = [-1.734723475976807e-18, 1.3e-26, -2.168404344971009e-19, 0.0, 2.8e-17, -5.7e-48]
    pull = [-5.551115123125783e-17, -8.3e-25, -6.938893903907228e-18, 0.0, -1.8e-15, 0.0]
    limits = MotionLimits(
        Derivatives(0.06, 0.42, 12.0), Derivatives(0.785, 5.5, 157.0), JointDerivatives.of(1, 1)
    )
    with pytest.raises(Refused, match='no jerk-limited move was found'):
        plan_move_in_motion(MotionState(goal, np.array(twist), np.array(pull)), goal, limits)


def test_the_acceleration_of_the_joints_where_a_plan_is_joined_counts():
    machine, dt = load('robocake'), 0.01
    home = machine.kinematics.home
    joints = machine.kinematics.inverse(home)
    plan = plan_line_move(home, home.moved([0.001, 0, 0, 0, 0, 0]), machine.motion.for_plans)
    most = machine.motion.for_plans.joint.acceleration * dt**2
    for share in (0.5, 2.0):
        before = joints - share * most * np.eye(6)[2]
        found = check_plan(plan, machine, joints, dt, before=before)
        assert found.fits == (share < 1.0)
    assert found.quantity == 'acceleration of crank_3'
