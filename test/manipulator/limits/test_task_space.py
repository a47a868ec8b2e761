"""Limits on where platform or tool may be, how it may be turned, and how fast it moves."""

import itertools
import re

import numpy as np
import pytest

from hexarm import machines
from hexarm.machine_check import problems_of
from hexarm.panel.room import shares
from manipulator import rotation as so3
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.reach import reach
from manipulator.analysis.readings import distance
from manipulator.analysis.travel import travel
from manipulator.analysis.volume import with_orientation
from manipulator.errors import ConfigError, Refused, Unreachable
from manipulator.framed_machine import in_frames
from manipulator.frames import Frames
from manipulator.limits.task_space import TaskSpaceConfig, pose_values
from manipulator.planning.cycle import Cycle
from manipulator.planning.goal import Goal, Motion
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest, plan_path
from manipulator.planning.plan import MotionState
from manipulator.planning.planner import check_cycle, plan_goal
from manipulator.planning.start import Start
from manipulator.planning.worker import Effort
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import Free
from manipulator.trajectory.executor import Executor
from manipulator.trajectory.jogging import JogCommand

DT = 0.01
TILT, TURN = 8.0, 10.0
HALF = {'robocake': 3.0, 'stewart_6_6': 3.0, 'arm_6r': 40.0}
SPEEDS = {'speeds_mm_s': (1e3, 1e3, 5.0), 'turning_speeds_deg_s': (1e3, 4.0, 1e3)}
FRAMES = Frames(Pose.from_xyz_rpy([0.01, 0.02, 0.0], [0.0, 0.0, 0.6])).with_pivot(
    [0.0, 0.01, 0.03]
)


def boxed(name, **others):
    """A machine within a box about home, a cone and a range of its turn."""
    machine, half = machines.load(name), HALF[name]
    middle = 1e3 * machine.kinematics.home.position
    ranges = [(p - half, p + half) for p in middle]
    config = TaskSpaceConfig(*ranges, tilt_deg=TILT, turn_deg=(-TURN, TURN), **others)
    return machine.within(config)


@pytest.fixture(scope='module', params=HALF)
def machine(request):
    return boxed(request.param)


def start_of(machine):
    home = machine.kinematics.home
    return Start(MotionState.at_rest(home), machine.kinematics.inverse(home), DT)


def moved(machine, six):
    """Home moved in units of the box, the cone and the range of the turn."""
    half = float(machine.constraints.high[-4] - machine.constraints.low[-4]) / 2
    units = [half] * 3 + [np.radians(TILT)] * 2 + [np.radians(TURN)]
    return machine.kinematics.home.moved(np.array(six) * units)


def test_tilt_is_the_angle_of_the_z_axes_and_turn_the_rotation_about_them():
    for tilt, direction, turn in ((0.4, 1.0, -2.5), (1.5, -2.0, 0.3), (0.0, 0.0, 3.0)):
        axis = tilt * np.array([np.cos(direction), np.sin(direction), 0.0])
        upright = so3.exp([0.3, -1.2, 0.5])
        pose = Pose(np.arange(3.0), upright @ so3.exp(axis) @ so3.exp([0.0, 0.0, turn]))
        np.testing.assert_allclose(pose_values(pose, upright), [0, 1, 2, tilt, turn], atol=1e-7)


@pytest.mark.parametrize('name', ['robocake', 'stewart_6_6'])
def test_a_platform_computes_the_values_of_the_definition(name):
    machine = boxed(name)
    home, rng = machine.kinematics.home, np.random.default_rng(1)
    poses = home.moved(rng.normal(0.0, 1.0, (500, 6)) * ([0.004] * 3 + [0.15] * 3))
    joints = machine.kinematics.inverse_or_nan(poses)
    expected = pose_values(poses, home.rotation)
    found = machine.constraints.values(poses, joints)[:, -5:]
    np.testing.assert_allclose(found, expected, atol=1e-9)
    admitted = machine.constraints.admits(poses, joints)
    low, high = machine.constraints.low[-5:], machine.constraints.high[-5:]
    inside = ((expected >= low) & (expected <= high)).all(axis=1)
    bare = machines.load(name).constraints.admits(poses, joints)
    assert 10 < admitted.sum() < bare.sum()
    assert np.array_equal(admitted, bare & inside)


@pytest.mark.parametrize(
    ('six', 'text'),
    [
        ((1.02, 0, 0, 0, 0, 0), r'position x -?0\.\d+ m outside \[-?0\.\d+, 0\.\d+\]'),
        ((0, 0, -1.02, 0, 0, 0), r'position z 0\.\d+ m outside \[0\.\d+, 0\.\d+\]'),
        ((0, 0, 0, 0, 1.02, 0), r'tilt 0\.1424 rad above 0\.1396'),
        ((0, 0, 0, 0, 0, -1.02), r'turn -?0\.178 rad outside \[-0\.1745, 0\.1745\]'),
    ],
)
def test_a_goal_beyond_a_limit_is_refused_with_its_name_value_and_bound(machine, six, text):
    start = start_of(machine)
    for motion in (Motion.LINE, Motion.JOINT):
        with pytest.raises((Refused, Unreachable)) as caught:
            plan_goal(machine, start, Goal(moved(machine, six), motion=motion), Effort())
        assert re.search(text, str(caught.value))
    assert plan_goal(machine, start, Goal(moved(machine, 0.9 * np.array(six))), Effort())
    found = reach(machine, moved(machine, six))
    assert not found.is_reachable
    assert re.search(text, found.reason)


def test_travel_ends_at_the_limit(machine):
    home = machine.kinematics.home
    for axis in range(6):
        way = travel(machine, home, np.eye(6)[axis])
        at_limit = home.twist_to(moved(machine, np.eye(6)[axis]))
        assert way.seconds == pytest.approx(np.abs(at_limit).max(), abs=1e-7)
        assert way.reason


def test_the_workspace_ends_at_the_box_and_the_page_shows_what_room_is_left(machine):
    home, low, high = machine.kinematics.home, machine.constraints.low, machine.constraints.high
    rng = np.random.default_rng(3)
    places = rng.uniform(low[-5:-2], high[-5:-2], (200, 3))
    beyond = places + rng.choice([-1.0, 1.0], (200, 3)) * (high[-5:-2] - low[-5:-2])
    reached = with_orientation(machine, home.rotation)
    assert reached(places).sum() > 100
    assert not reached(beyond).any()
    at_limit = moved(machine, (0.999, 0, 0, 0, 0, 0))
    left = shares(machine, at_limit, machine.kinematics.inverse(at_limit))['']
    assert left == pytest.approx(0.001, abs=1e-6)


def test_the_nearest_pose_keeps_the_limits_and_no_admitted_neighbour_is_nearer(machine):
    target = moved(machine, (3.0, 0.5, -2.0, 1.5, 0.2, 2.0))
    found = nearest_reachable(machine, target)
    assert reach(machine, found.pose).is_reachable
    rng, length = np.random.default_rng(2), machine.kinematics.characteristic_length
    steps = rng.standard_normal((3000, 6)) * rng.choice([1e-2, 1e-3, 1e-4], (3000, 1)) * length
    steps[:, 3:] /= length
    near = found.pose.moved(steps)
    joints = machine.kinematics.inverse_or_nan(near)
    inside = machine.constraints.admits(near, joints) & np.isfinite(joints).all(axis=1)
    assert inside.any()
    assert distance(machine, near[inside], target).min() > found.distance - 1e-4 * length


@pytest.mark.parametrize('is_framed', [False, True])
def test_a_jog_stops_at_every_limit_and_comes_back(machine, is_framed):
    machine = in_frames(machine, FRAMES) if is_framed else machine
    motion, home = machine.motion, machine.kinematics.home
    full = np.repeat([motion.linear.speed, motion.angular.speed], 3) * [1, -1, 1, -1, 1, -1]
    for axis in range(6):
        executor = Executor(machine, home, machine.kinematics.inverse(home), DT)
        twist = full * np.eye(6)[axis]
        poses, reasons = jogged(executor, twist, 90)
        machine.constraints.check(poses[-1], executor.joints)
        assert any(re.search('position [xyz]|tilt|turn', reason) for reason in reasons)
        change = norms(np.diff(twists_of(poses), axis=0)) / DT
        assert change[:, 0].max() <= 1.02 * motion.linear.acceleration
        assert change[:, 1].max() <= 1.02 * motion.angular.acceleration
        values = machine.constraints.values(poses[-1], executor.joints)[-5:]
        low, high = machine.constraints.low[-5:], machine.constraints.high[-5:]
        assert np.minimum(values - low, high - values).min() < 1e-4
        back, _ = jogged(executor, -twist, 30)
        assert np.abs(back[0].twist_to(back[-1])).max() > 1e-3


def jogged(executor, twist, ticks):
    poses, reasons = [executor.state.pose], set()
    for _ in range(ticks):
        executor.jog(JogCommand('cmd_vel', twist, '', Free()))
        poses.append(executor.step())
        reasons.add(executor.status.reason)
    return poses, reasons


def twists_of(poses):
    return np.array([a.twist_to(b) for a, b in itertools.pairwise(poses)]) / DT


def norms(twists):
    """Of the linear and the angular part, (n, 2)."""
    return np.linalg.norm(twists.reshape(-1, 2, 3), axis=2)


def fastest(poses):
    """By axis, m/s and rad/s."""
    return np.abs(poses[:-1].twist_to(poses[1:])).max(axis=0) / 1e-3


@pytest.mark.parametrize('name', HALF)
def test_goals_paths_and_jogs_keep_the_speed_of_each_axis(name):
    machine = boxed(name, **SPEEDS)
    home, near = machine.kinematics.home, machine.kinematics.inverse(machine.kinematics.home)
    start = start_of(machine)
    most = 1.01 * machine.motion.axis_speeds
    goals = [moved(machine, six) for six in ((0.1, 0, 0.9, 0, 0, 0), (0, 0.3, 0, 0.1, 0.9, 0.2))]
    for goal in goals:
        for motion in (Motion.LINE, Motion.JOINT):
            plan = plan_goal(machine, start, Goal(goal, motion=motion), Effort())
            speeds = fastest(plan.at(np.arange(0.0, plan.duration, 1e-3)).pose)
            assert (speeds <= most).all()
            assert (speeds[[2, 4]] / most[[2, 4]]).max() > 0.9
    path = Pose(
        np.array([home.position, goals[0].position, goals[1].position]),
        np.array([home.rotation, goals[0].rotation, goals[1].rotation]),
    )
    plan = plan_path(machine, PathRequest(path, 10.0, Tolerance()), near, DT)
    assert (fastest(plan.at(np.arange(0.0, plan.duration, 1e-3)).pose) <= most).all()
    executor = Executor(machine, home, near, DT)
    up, _ = jogged(executor, np.eye(6)[2], 30)
    down, _ = jogged(executor, -np.eye(6)[2] - np.eye(6)[4], 30)
    speeds = np.abs(twists_of([*up, *down])).max(axis=0)
    assert (speeds <= most).all()
    assert speeds[2] > 0.95 * machine.motion.axis_speeds[2]


def test_a_cycle_that_is_too_fast_along_an_axis_is_refused_with_its_name():
    machine = boxed('robocake', **SPEEDS)
    home = machine.kinematics.home
    cycle = Cycle(home, np.eye(6)[2] * 2e-3, np.full(6, 0.8), np.zeros(6))
    with pytest.raises(Refused, match=r'linear z speed is 2\.01 times too fast'):
        check_cycle(machine, cycle, machine.kinematics.inverse(home), DT)


def test_an_arm_counts_tilt_from_the_upright_that_its_file_gives():
    arm = machines.load('puma560')
    tilted = TaskSpaceConfig(tilt_deg=20.0)
    down = TaskSpaceConfig(tilt_deg=20.0, upright_rpy_deg=(180.0, 0.0, 0.0))
    assert arm.within(tilted).constraints.limits[-1].quantity == 'tilt'
    with pytest.raises(ConfigError, match='task_space: home has tilt 90°, above 20°'):
        arm.within(down)
    with pytest.raises(
        ConfigError, match=r'task_space\.upright_rpy_deg: tilt and turn of a platf'
    ):
        machines.load('robocake').within(down)


def test_check_names_every_fault_at_once():
    text = machines.text_of(machines.find('robocake')) + (
        'task_space: {x_mm: [3, -3], y_mm: [5, 9], tilt_deg: 200, turn_deg: [-9, 9, 1],'
        ' speeds_mm_s: [1, 0, 1], tilt: 3}\n'
    )
    assert problems_of(text) == [
        "task_space.tilt: unknown key, did you mean 'tilt_deg'?",
        'task_space.tilt_deg: 200 outside [0.001, 180]',
        'task_space.turn_deg: has 3 entries, needs 2',
        'task_space.speeds_mm_s[1]: 0 outside [1e-06, 1e+09]',
    ]
    assert problems_of(
        text.replace(' tilt_deg: 200, turn_deg: [-9, 9, 1],', '').replace(
            ' speeds_mm_s: [1, 0, 1], tilt: 3', ''
        )
    ) == ['task_space: x_mm: [3, -3] is no range']
    good = text[: text.index('task_space')] + 'task_space: {y_mm: [5, 9], z_mm: [50, 60]}\n'
    assert problems_of(good) == [
        'task_space: home has position y 0 mm, outside [5, 9] mm',
        'task_space: home has position z 41.19 mm, outside [50, 60] mm',
    ]
