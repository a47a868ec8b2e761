"""Timed paths against real machines: what they demand is measured by differences of the joints."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexapod_control import workspace
from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.errors import Refused
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal
from manipulator.planning.path import Tolerance, arc, line, path_along
from manipulator.planning.path_limits import path_limits
from manipulator.planning.path_timing import PathRequest, TimedPath, nodes_of, plan_path
from manipulator.pose import Pose
from manipulator.trajectory.executor import Executor

DT = 0.01
MACHINES = {name: load(name) for name in ('robocake', 'stewart_6_3', 'arm_6r')}
ROBOCAKE = MACHINES['robocake']
HOME = ROBOCAKE.kinematics.home
REACHABLE = workspace.sample(ROBOCAKE, 400, np.random.default_rng(5))


def planned(machine, poses, speed=None, stamps=None, tolerance=None):
    near = machine.kinematics.inverse(machine.kinematics.home)
    allowed = tolerance or Tolerance()
    request = PathRequest(poses, speed or machine.motion.linear.speed, allowed, stamps)
    return plan_path(machine, request, near, DT)


def circle_at_home(machine, radius, count=120):
    home = machine.kinematics.home
    angle = np.linspace(0.0, 2 * np.pi, count)
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    return Pose(home.position + radius * ring, home.rotation)


def largest_shares(machine, plan, h=1e-3):
    """Speeds and accelerations as parts of their limits, by differences over h seconds."""
    pose = plan.at(np.arange(0.0, plan.duration + h, h)).pose
    joints = machine.kinematics.inverse_along(pose, plan.joints)
    twist = pose[:-1].twist_to(pose[1:]) / h
    motion = machine.motion.for_plans
    found = []
    for values, limit in (
        (np.linalg.norm(twist[:, :3], axis=1), motion.linear),
        (np.linalg.norm(twist[:, 3:], axis=1), motion.angular),
        (np.diff(joints, axis=0) / h, motion.joint),
    ):
        found.append(np.abs(values / limit.speed).max())
    for values, limit in (
        (np.linalg.norm(np.diff(twist[:, :3], axis=0), axis=1) / h, motion.linear),
        (np.linalg.norm(np.diff(twist[:, 3:], axis=0), axis=1) / h, motion.angular),
        (np.diff(joints, n=2, axis=0) / h**2, motion.joint),
    ):
        found.append(np.abs(values / limit.acceleration).max())
    return np.array(found)


@pytest.mark.parametrize(
    ('name', 'radius'), [('robocake', 0.008), ('stewart_6_3', 0.01), ('arm_6r', 0.08)]
)
def test_circle_keeps_all_limits_and_reaches_one(name, radius):
    machine = MACHINES[name]
    plan = planned(machine, circle_at_home(machine, radius))
    shares = largest_shares(machine, plan)
    assert shares.max() <= 1.01
    assert shares.max() >= 0.97
    first, last = plan.at(0.0), plan.at(plan.duration)
    assert np.abs(first.twist).max() < 1e-9
    assert np.abs(last.twist).max() < 1e-6


@pytest.fixture(scope='module')
def on_a_path():
    """Limits of a crooked path, its twists, and squared speeds at its nodes, at random."""
    rng = np.random.default_rng(6)
    picks = rng.uniform(-1.0, 1.0, (8, 6)) * ([0.004] * 3 + [0.05] * 3)
    poses = Pose.from_xyz_rpy(HOME.position + picks[:, :3], picks[:, 3:])
    path = path_along(poses, Tolerance(), 0.05)
    nodes = nodes_of(path, 1, ROBOCAKE.kinematics.characteristic_length)
    limits = path_limits(ROBOCAKE, path, nodes, ROBOCAKE.kinematics.inverse(poses[0]))
    return limits, path.at(nodes), rng.uniform(0.0, 1e-3, len(nodes))


def accelerations(rates, nodes, squares):
    """At the begin and the end of each step between two nodes, (2, m, n)."""
    steps = np.diff(nodes)[:, None]
    bend, pull = np.diff(rates, axis=0) / steps, np.diff(squares)[:, None] / (2 * steps)
    begin = rates[:-1] * pull + bend * squares[:-1, None]
    return np.stack([begin, rates[1:] * pull + bend * squares[1:, None]])


def said_by_rows(limits, squares, name):
    columns = [k for k, row in enumerate(limits.row_names) if row == f'{name} acceleration']
    rows = limits.rows.on_begin * squares[:-1, None] + limits.rows.on_end * squares[1:, None]
    return rows[:, columns].max(axis=1)


@pytest.mark.parametrize(('name', 'part'), [('linear', slice(0, 3)), ('turning', slice(3, 6))])
def test_rows_of_a_path_report_how_much_the_platform_accelerates(on_a_path, name, part):
    """At either end of a step, within the polygon of directions: 15° from corner to corner."""
    limits, state, squares = on_a_path
    both = accelerations(state.twist[:, part], limits.nodes, squares)
    longest = np.linalg.norm(both, axis=2).max(axis=0)
    text = said_by_rows(limits, squares, name)
    assert (text <= longest * (1 + 1e-9)).all()
    assert (text >= longest * np.cos(np.radians(7.5)) * (1 - 1e-9)).all()


def test_rows_of_a_path_report_how_much_each_joint_accelerates(on_a_path):
    limits, state, squares = on_a_path
    jacobian = ROBOCAKE.kinematics.jacobian(state.pose, limits.joints)
    rates = np.linalg.solve(jacobian, state.twist[..., None])[..., 0]
    most = np.abs(accelerations(rates, limits.nodes, squares)).max(axis=0)
    for k, name in enumerate(ROBOCAKE.kinematics.joint_names):
        np.testing.assert_allclose(said_by_rows(limits, squares, name), most[:, k], atol=1e-9)


def test_path_takes_little_longer_than_its_length_at_full_speed():
    plan = planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008))
    assert plan.duration < 1.05 * 2 * np.pi * 0.008 / ROBOCAKE.motion.linear.speed


def test_path_is_driven_at_the_speed_asked_for():
    plan = planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008), speed=0.01)
    speeds = np.linalg.norm(plan.at(np.linspace(0, plan.duration, 999)).twist[:, :3], axis=1)
    assert speeds.max() <= 0.01 + 1e-9
    assert np.median(speeds) == pytest.approx(0.01, rel=1e-3)


def test_sharp_corner_is_passed_without_a_stop_and_within_tolerance():
    corner = HOME.position + np.array([[0, 0, 0], [0.008, 0, 0], [0.008, 0.008, 0]])
    plan = planned(ROBOCAKE, Pose(corner, np.eye(3)))
    state = plan.at(np.linspace(0, plan.duration, 5000))
    middle = np.abs(np.linspace(0, 1, 5000) - 0.5) < 0.45
    assert np.linalg.norm(state.twist[middle, :3], axis=1).min() > 0.01
    missed = np.linalg.norm(state.pose.position - corner[1], axis=1).min()
    assert 1e-6 < missed <= 1e-4


def test_twist_and_acceleration_are_the_derivatives_of_the_pose():
    plan, h = planned(ROBOCAKE, Pose(*turned_line())), 1e-6
    t = np.random.default_rng(0).uniform(h, plan.duration - h, 300)
    before, now, after = (plan.at(t + k * h) for k in (-1, 0, 1))
    twist = before.pose.twist_to(after.pose) / (2 * h)
    np.testing.assert_allclose(now.twist, twist, atol=1e-5)
    change = (after.twist - before.twist) / (2 * h)
    is_smooth = np.abs(after.acceleration - before.acceleration).max(axis=1) < 1e-3
    assert is_smooth.mean() > 0.5
    np.testing.assert_allclose(now.acceleration[is_smooth], change[is_smooth], atol=1e-3)


def turned_line():
    position = HOME.position + np.array([[0, 0, 0], [0.006, 0.002, 0.002], [0.006, -0.004, 0]])
    return position, so3.from_rpy([(0, 0, 0), (0.05, 0, 0), (0.05, 0.04, 0.02)])


def test_turn_in_place_is_driven_within_the_turning_speed():
    poses = line(HOME, Pose(HOME.position, so3.from_rpy((0.0, 0.0, 0.2))))
    plan = planned(ROBOCAKE, poses)
    shares = largest_shares(ROBOCAKE, plan)
    assert shares.max() <= 1.01
    assert np.abs(plan.at(plan.duration).pose.twist_to(poses[1])).max() < 1e-9


def test_stamped_path_keeps_its_stamps_but_for_the_ends():
    poses, stamps = circle_at_home(ROBOCAKE, 0.008, 50), 1e3 + np.linspace(0.0, 3.0, 50)
    plan = planned(ROBOCAKE, poses, stamps=stamps)
    assert 3.0 < plan.duration < 3.1
    late = plan.duration - 3.0
    middle = plan.at(1.5 + late / 2).pose
    on_time = circle_at_home(ROBOCAKE, 0.008, 99)[49]
    assert np.abs(middle.twist_to(on_time)).max() < 1e-4
    speeds = np.linalg.norm(plan.at(np.linspace(0.2, 2.8, 200)).twist[:, :3], axis=1)
    assert np.ptp(speeds) < 0.001 * speeds.max() + 1e-4


def test_path_stamped_too_fast_is_refused_with_place_limit_and_factor():
    stamps = np.linspace(0.0, 0.5, 50)
    with pytest.raises(Refused, match=r'pose \d+, .* linear speed would be 2.* times too fast'):
        planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008, 50), stamps=stamps)


def test_dwelling_between_stamps_is_a_dwell():
    points = HOME.position + np.array([[0, 0, 0], [0.005, 0, 0], [0.005, 0, 0], [0, 0, 0]])
    stamps = np.array([0.0, 1.0, 2.0, 3.0])
    plan = planned(ROBOCAKE, Pose(points, np.eye(3)), stamps=stamps)
    still = plan.at(np.linspace(1.2, 1.8, 20)).pose.position
    np.testing.assert_allclose(still, points[1] + np.zeros((20, 3)), atol=1e-4)


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_3', 'arm_6r'])
def test_path_that_leaves_the_reach_is_refused_with_pose_metres_and_reason(name):
    machine = MACHINES[name]
    home = machine.kinematics.home
    away = Pose(home.position + np.outer([0, 0.4, 0.7, 1.0], [0, 0, 2.0]), home.rotation)
    with pytest.raises(Refused, match=r'(at|after) pose 1, .* m along the path: \w+'):
        planned(machine, away)


def test_path_that_would_take_hours_is_refused():
    with pytest.raises(Refused, match='would take'):
        planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008), speed=1e-6)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.integers(0, 399), min_size=2, max_size=8), st.floats(0.005, 0.05))
def test_random_paths_inside_the_workspace_are_refused_or_driven_within_all_limits(picks, speed):
    poses = REACHABLE[np.array(picks)]
    near = ROBOCAKE.kinematics.inverse(poses[0])
    try:
        plan = plan_path(ROBOCAKE, PathRequest(poses, speed, Tolerance()), near, DT)
    except Refused as error:
        assert 'along the path' in str(error)
        return
    if isinstance(plan, TimedPath):
        assert largest_shares(ROBOCAKE, plan, DT).max() <= 1.02


def test_executor_goes_to_the_first_pose_and_along_the_path_and_stops_on_it():
    plan = planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008))
    executor = Executor(ROBOCAKE, HOME, ROBOCAKE.kinematics.inverse(HOME), DT)
    elsewhere = Pose.from_xyz_rpy((0.004, -0.003, 0.045))
    executor.pursue(Goal(elsewhere, 1.0))
    for _ in range(20):
        executor.step()
    executor.pursue(Goal(plan.at(0.0).pose, 2.0, then=plan))
    poses, joints = [], []
    while executor.status.result != 'stopped':
        poses.append(executor.step())
        joints.append(executor.joints)
        if executor.status.percent is not None and executor.status.percent > 40:
            executor.stop()
    seen = np.array([p.position for p in poses[-60:]]) - HOME.position
    radii = np.hypot(seen[:, 0], seen[:, 1])
    assert np.ptp(radii[-40:]) < 1e-5
    assert np.abs(np.diff(joints, axis=0)).max() / DT <= 1.01 * ROBOCAKE.motion.joint.speed
    acceleration = np.abs(np.diff(joints, n=2, axis=0)).max() / DT**2
    assert acceleration <= 1.01 * ROBOCAKE.motion.joint.acceleration
    assert executor.status.goal_stamp == 2.0


def test_newer_goal_is_joined_from_the_middle_of_a_path():
    plan = planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008))
    executor = Executor(ROBOCAKE, HOME, ROBOCAKE.kinematics.inverse(HOME), DT)
    executor.pursue(Goal(plan.at(0.0).pose, 1.0, then=plan))
    for _ in range(50):
        executor.step()
    assert executor.status.mode == 'path'
    executor.pursue(Goal(HOME, 2.0))
    for _ in range(200):
        executor.step()
    assert (executor.status.mode, executor.status.result) == ('hold', 'reached')
    assert executor.status.goal_stamp == 2.0


def test_path_on_another_branch_of_the_joints_is_not_begun():
    plan = planned(ROBOCAKE, circle_at_home(ROBOCAKE, 0.008))
    other = TimedPath(plan.path, plan.nodes, plan.squares, plan.joints + 1.0)
    executor = Executor(ROBOCAKE, HOME, ROBOCAKE.kinematics.inverse(HOME), DT)
    executor.pursue(Goal(plan.at(0.0).pose, 1.0, then=other))
    for _ in range(50):
        executor.step()
    assert executor.status.result == 'refused'
    assert 'branch' in executor.status.reason


@pytest.mark.parametrize('command', ['goal', 'stop', 'cycle'])
def test_newer_command_ends_the_wait_for_a_path(command):
    executor = Executor(ROBOCAKE, HOME, ROBOCAKE.kinematics.inverse(HOME), DT)
    executor.expect(5.0)
    assert (executor.status.result, executor.status.goal_stamp) == ('planning', 5.0)
    if command == 'goal':
        executor.pursue(Goal(HOME, 6.0))
    elif command == 'stop':
        executor.stop()
    else:
        executor.start_cycle(Cycle(HOME, [0.001, 0, 0, 0, 0, 0], [0.5] * 6, [0] * 6))
    assert executor.expected is None


def test_arc_of_the_arm_turns_the_tool_along():
    machine = MACHINES['arm_6r']
    home = machine.kinematics.home
    poses = arc(home, home.position + np.array([0.0, 0.1, 0.0]), (0, 0, 1), 1.0, is_turning=True)
    plan = planned(machine, poses)
    assert largest_shares(machine, plan).max() <= 1.02
    end = plan.at(plan.duration).pose
    np.testing.assert_allclose(end.rotation, so3.exp([0, 0, 1.0]) @ home.rotation, atol=1e-9)
