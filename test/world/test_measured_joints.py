"""Goals and paths of machines whose joints are measured: the loop is closed on them.

The servos have play, which open-loop commands leave as an error.
"""

import numpy as np
import pytest

from hexarm import machines
from manipulator.planning.path import Tolerance, arc
from manipulator.planning.path_timing import PathRequest
from manipulator.pose import Pose
from manipulator.trajectory.correction import MOST_CORRECTION
from manipulator.trajectory.following_error import Tolerances
from manipulator.trajectory.path_planning import PathGoal
from world.requests import Requests

ARM = 'arm_6r_stepper'
PLAY = np.radians(2.0)
STEPS = (
    (0.05, -0.05, 0.05, 0.2, 0.1, -0.1),
    (-0.05, 0.08, -0.05, -0.2, 0.1, 0.2),
    (0, 0, 0.08, 0, 0, 0),
)
DT = 0.01
RADIUS = 0.05


@pytest.fixture
def measured_platform(tmp_path):
    """A platform on linear drives that measure: the name of its file, and a play of 1 mm."""
    text = machines.find('stewart_6_6').read_text()
    assert '\nsimulation:' in text
    text = text.replace('\nsimulation:', '\nsimulation:\n  joints: measured', 1)
    path = tmp_path / 'measured.yaml'
    path.write_text(text)
    return str(path), 1e-3


def distance(world, goal):
    return np.linalg.norm(world.pose.twist_to(goal)[:3])


def commands(world):
    """Joints (N, 6) that the inverse kinematics sent, and the mean times between them."""
    return np.array([joints for _, joints in world.inverse.published])


def assert_within_limits(world):
    """Speeds and accelerations of all commands but the first, which is where the joints are."""
    limits, rows = world.machine.motion.joint, commands(world)[1:]
    speed = np.diff(rows, axis=0) / DT
    assert (np.abs(speed) <= 1.001 * limits.speed).all()
    acceleration = np.diff(speed, axis=0) / DT
    assert (np.abs(acceleration) <= 1.001 * limits.acceleration).all()
    low, high = world.machine.joint_ranges
    assert ((rows >= low) & (rows <= high)).all()
    assert world.inverse.on_setpoint.refusals == []


def test_goals_are_reached_within_half_a_millimetre_in_spite_of_play(make_world):
    world = make_world(ARM, PLAY)
    for step in STEPS:
        goal = world.machine.kinematics.home.moved(np.array(step))
        assert world.go_to(goal).result == 'reached'
        assert distance(world, goal) < 5e-4
        world.run(1.0)
        assert distance(world, goal) < 5e-4
    assert_within_limits(world)


def test_a_platform_on_drives_in_metres_reaches_its_goals_in_spite_of_play(
    make_world, measured_platform
):
    world = make_world(*measured_platform)
    home = world.machine.kinematics.home
    for step in ((0.01, -0.01, 0.005, 0.05, 0.0, 0.05), (-0.01, 0.0, -0.005, 0.0, 0.05, -0.05)):
        goal = home.moved(np.array(step))
        assert world.go_to(goal).result == 'reached'
        assert distance(world, goal) < 5e-4
    assert_within_limits(world)


def circle(home, radius=RADIUS):
    centre = home.position + np.array([0.0, 0.0, 0.05])
    return centre, arc(
        Pose(centre + np.array([radius, 0.0, 0.0]), home.rotation), centre, (0, 0, 1), 2 * np.pi
    )


def followed(world, speed, stamps=None, radius=RADIUS):
    """A circle from its first pose: the distance from it (N,) (m), and the seconds on the path."""
    centre, poses = circle(world.machine.kinematics.home, radius)
    assert world.go_to(poses[0]).result == 'reached'
    request = PathRequest(poses, speed, Tolerance(), stamps)
    stamp, core, points = world.user.stamp, world.controller.core, []
    path = PathGoal(stamp, lambda: request, is_of_platform=True)
    core.follow(path, lambda error: core.refuse(stamp, error), world.now)
    world.wait('path', lambda: world.status.mode == 'path')
    while world.status.mode == 'path':
        world.run(DT)
        points.append(world.pose.position - centre)
    assert world.end_of(stamp).result == 'reached'
    x, y, z = np.array(points).T
    return np.hypot(np.hypot(x, y) - radius, z), len(points) * DT


@pytest.mark.parametrize(('speed', 'radius'), [(0.03, 0.01), (0.1, 0.03), (0.25, RADIUS)])
def test_a_path_is_followed_within_half_a_millimetre_rms_in_spite_of_play(
    make_world, speed, radius
):
    world = make_world(ARM, PLAY)
    off, _ = followed(world, speed, radius=radius)
    assert np.sqrt((off**2).mean()) < 5e-4
    assert_within_limits(world)


def test_a_path_is_not_slowed_down_where_there_is_no_play(make_world):
    off, seconds = followed(make_world(ARM, 0.0), 0.1)
    assert off.max() < 5e-4
    assert seconds < 2 * np.pi * RADIUS / 0.1 + 0.5


def test_a_stamped_path_keeps_its_times_in_spite_of_play(make_world):
    world = make_world(ARM, PLAY)
    count = len(circle(world.machine.kinematics.home)[1].position)
    _, seconds = followed(world, 0.1, np.linspace(0.0, 3.0, count))
    assert seconds < 3.0 + 1.0  # the play of its first motion is taken up before it begins


@pytest.mark.parametrize('lateness', [0.06, 0.12])
def test_measurements_up_to_three_times_as_late_as_assumed_end_at_the_goal(make_world, lateness):
    world = make_world(ARM, PLAY)
    for name in ('joints', 'pose'):
        world.links[name].delay += lateness
    home = world.machine.kinematics.home
    for step in STEPS[:2]:
        goal = home.moved(np.array(step))
        since = len(world.board.true_joints)
        assert world.go_to(goal).result == 'reached'
        assert distance(world, goal) < 5e-4
        world.run(1.0)
        assert distance(world, goal) < 5e-4
        assert overshoot(world, goal, since) < np.radians(0.5)
    assert_within_limits(world)


def overshoot(world, goal, since):
    """The most that a joint went beyond the range between its start and the goal, rad."""
    rows = np.array([joints for _, joints in world.board.true_joints[since:]])[:, :6]
    end = world.machine.kinematics.inverse(goal, rows[-1])
    low, high = np.minimum(rows[0], end), np.maximum(rows[0], end)
    return max((low - rows).max(), (rows - high).max())


def test_without_measurements_the_correction_stays_as_it_is(make_world):
    world = make_world(ARM, PLAY)
    goal = world.machine.kinematics.home.moved(np.array(STEPS[0]))
    world.send_goal(goal)
    world.run(0.3)
    for name in ('joints', 'pose'):
        world.links[name].loses = lambda: True
    world.run(0.15)
    for name in ('joints', 'pose'):
        world.links[name].loses = lambda: False
    world.wait('end', lambda: world.status.result == 'reached')
    assert distance(world, goal) < 5e-4
    assert_within_limits(world)


def test_a_stuck_joint_is_named_and_its_correction_stays_small(make_world):
    world = make_world(ARM, PLAY)
    since = len(world.inverse.published)
    world.board.stuck_channel = 1
    goal = world.machine.kinematics.home.moved(np.array((0.0, 0.0, -0.03, 0.0, 0.0, 0.0)))
    start = commands(world)[-1]
    end = world.machine.kinematics.inverse(goal, start)
    status = world.go_to(goal)
    assert status.result == 'stopped'
    assert 'joint_2' in status.reason
    world.run(2.0)
    low, high = np.minimum(start, end), np.maximum(start, end)
    most = MOST_CORRECTION * Tolerances.of(world.machine).following
    rows = commands(world)[since:]
    assert ((rows > low - 1.01 * most - PLAY) & (rows < high + 1.01 * most + PLAY)).all()
    assert_within_limits(world)


def test_a_joint_at_the_end_of_its_range_is_not_sent_beyond(make_world):
    world = make_world(ARM, PLAY)
    kinematics = world.machine.kinematics
    _, high = world.machine.joint_ranges
    joints = kinematics.inverse(kinematics.home).copy()
    joints[4] = high[4] - 1e-4
    goal = kinematics.forward(joints).pose
    status = world.go_to(goal)
    assert status.result in ('reached', 'stopped')
    world.run(1.0)
    assert_within_limits(world)
    assert world.go_to(kinematics.home).result == 'reached'


def test_at_rest_the_command_is_constant(make_world):
    world = make_world(ARM, PLAY)
    assert world.go_to(world.machine.kinematics.home.moved(np.array(STEPS[0]))).result == 'reached'
    world.run(0.3)
    since = len(world.inverse.published)
    world.run(1.5)
    assert np.ptp(commands(world)[since:], axis=0).max() < 1e-9


def test_after_a_stop_nothing_moves(make_world):
    world = make_world(ARM, PLAY)
    world.send_goal(world.machine.kinematics.home.moved(np.array(STEPS[0])))
    world.run(0.3)
    world.controller.core.stop()
    world.wait('stop', lambda: world.status.result == 'stopped')
    world.run(0.3)
    since = len(world.inverse.published)
    world.run(2.0)
    assert np.ptp(commands(world)[since:], axis=0).max() < 1e-9


def test_an_error_that_cannot_be_corrected_ends_stopped_with_the_distance(make_world):
    world = make_world(ARM, np.radians(9.0))
    status = world.go_to(world.machine.kinematics.home.moved(np.array(STEPS[0])))
    assert status.result == 'stopped'
    assert 'the goal is missed by' in status.reason


def test_where_joints_are_not_measured_the_setpoint_is_the_plan(make_world):
    world = make_world('arm_6r', PLAY)
    goal = world.machine.kinematics.home.moved(np.array(STEPS[0]))
    world.go_to(goal)
    world.run(0.5)
    end = world.machine.kinematics.forward(commands(world)[-1]).pose
    assert np.abs(end.twist_to(goal)).max() < 1e-6


def begin_waiting(world):
    """A path that has been approached, and waits for its play; its stamp."""
    _, poses = circle(world.machine.kinematics.home)
    stamp = world.send_path(poses, speed=0.05)
    world.wait('approach', lambda: world.controller.supervisor.executor.is_waiting)
    return stamp


def test_a_path_that_waits_for_its_arrival_is_stopped_at_once(make_world):
    world = make_world(ARM, PLAY)
    stamp = begin_waiting(world)
    world.controller.core.stop()
    assert world.end_of(stamp).result == 'stopped'
    world.run(0.3)
    since = len(world.inverse.published)
    world.run(2.0)
    assert np.ptp(commands(world)[since:], axis=0).max() < 1e-9
    assert world.go_to(world.machine.kinematics.home).result == 'reached'


def test_a_path_that_waits_for_its_arrival_gives_way_to_a_goal_and_to_a_pause(make_world):
    world = make_world(ARM, PLAY)
    begin_waiting(world)
    world.controller.supervisor.pause(True)
    world.run(5.0)
    since = len(world.inverse.published)
    world.run(1.0)
    assert np.ptp(commands(world)[since:], axis=0).max() < 1e-9
    world.controller.supervisor.pause(False)
    begin_waiting(world)
    assert world.go_to(world.machine.kinematics.home).result == 'reached'
    assert_within_limits(world)


def test_a_path_whose_first_pose_is_not_reached_ends_there_with_the_distance(make_world):
    world = make_world(ARM, np.radians(9.0))
    status = world.end_of(begin_waiting(world))
    assert status.result == 'stopped'
    assert status.reason.startswith('before the path begins: ')
    assert 'the goal is missed by' in status.reason
    since = len(world.inverse.published)
    world.run(3.0)
    assert np.ptp(commands(world)[since + 30 :], axis=0).max() < 1e-9


def test_a_cycle_begins_when_its_play_is_taken_up_and_stops(make_world):
    world = make_world(ARM, PLAY)
    Requests(world).cycle(amplitude=[0.02, 0.02, 0.01, 0.05, 0.05, 0.05])
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    world.run(3.0)
    Requests(world).stop()
    world.wait('stop', lambda: world.status.result == 'stopped')
    assert_within_limits(world)
