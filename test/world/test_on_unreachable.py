"""Goals out of reach where the nearest pose is asked for."""

import itertools
import re

import numpy as np
import pytest

from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.readings import distance
from manipulator.planning.goal import OnUnreachable
from sampling import enough
from world.controller import DT

RADIUS = {'robocake': 0.03, 'stewart_6_6': 0.2, 'arm_6r': 0.5}
FARTHER = {'robocake': 0.02, 'stewart_6_6': 0.02, 'arm_6r': 0.05}
"""Part of the least distance by which an answer may be farther away."""


@pytest.fixture
def make_nearest(make_world):
    def make(name):
        world = make_world(name)
        world.controller.on_unreachable = OnUnreachable.NEAREST
        return world

    return make


def setpoints_of(world):
    poses, send = [], world.controller._setpoints.send

    def keep(stamp, pose):
        poses.append(pose)
        send(stamp, pose)

    world.controller._setpoints.send = keep
    return poses


def circle(home, radius, seconds, count=150):
    """Out along x within a third of the time, then a tenth of a turn about home."""
    for k in range(count):
        share = min(3.0 * k / count, 1.0)
        angle = 2 * np.pi * 0.1 * k / count
        yield home.moved(share * radius * np.array([np.cos(angle), np.sin(angle), 0, 0, 0, 0]))


@pytest.mark.parametrize('name', RADIUS)
def test_a_stream_out_of_reach_is_followed_along_the_limits(make_nearest, name):
    world = make_nearest(name)
    machine, motion = world.machine, world.machine.motion
    poses, since = setpoints_of(world), len(world.controller.statuses)
    for goal in circle(machine.kinematics.home, RADIUS[name], 2.5, enough(90, 150)):
        stamp = world.send_goal(goal)
        world.run(1 / 60)
    results = {status.result for _, status in world.controller.statuses[since:]}
    assert not results & {'refused', 'stopped'}
    status = world.end_of(stamp)
    assert status.result == 'reached'
    assert re.match(r'nearest reachable pose, [\d.]+ mm and [\d.]+° from', status.reason)
    twists = np.array([a.twist_to(b) for a, b in itertools.pairwise(poses)]) / DT
    changes = np.diff(twists, axis=0) / DT
    for part, limit in ((slice(0, 3), motion.linear), (slice(3, 6), motion.angular)):
        assert np.linalg.norm(twists[:, part], axis=1).max() <= 1.01 * limit.speed
        assert np.linalg.norm(changes[:, part], axis=1).max() <= 1.01 * limit.acceleration
    near = None
    for pose in poses:
        near = machine.kinematics.inverse(pose, near)
        machine.constraints.check(pose, near)
    least = nearest_reachable(machine, goal).distance
    assert float(distance(machine, poses[-1], goal)) <= (1.0 + FARTHER[name]) * least


def test_a_goal_back_in_reach_is_reached_itself(make_nearest):
    world = make_nearest('robocake')
    home = world.machine.kinematics.home
    assert 'nearest' in world.go_to(home.moved([0.05, 0, 0, 0, 0, 0])).reason
    goal = home.moved([0.003, 0.001, 0, 0, 0, 0.1])
    status = world.go_to(goal)
    assert (status.result, status.reason) == ('reached', '')
    at = world.controller.supervisor.executor.state.pose
    assert np.abs(at.twist_to(goal)).max() < 1e-9


def test_a_goal_that_is_absurd_is_refused_all_the_same(make_nearest):
    world = make_nearest('robocake')
    status = world.go_to(world.machine.kinematics.home.moved([1e6, 0, 0, 0, 0, 0]))
    assert status.result == 'refused'
    assert 'm from home, needs at most' in status.reason


FAR_APART = {
    'robocake': (
        (0.072, 0.008, -0.059, -0.46, -0.23, 0.11),
        (-0.081, -0.017, -0.013, 0.27, 0.1, 0.18),
    ),
    'stewart_6_6': (
        (0.27, 0.03, -0.22, -0.46, -0.23, 0.11),
        (-0.3, -0.06, -0.05, 0.27, 0.1, 0.18),
    ),
}


@pytest.mark.parametrize('name', FAR_APART)
def test_limits_that_bend_are_followed_where_the_line_to_the_nearest_pose_is_blocked(
    make_nearest, name
):
    world = make_nearest(name)
    machine = world.machine
    for offset in FAR_APART[name]:
        goal = machine.kinematics.home.moved(offset)
        status = world.go_to(goal)
        assert status.result == 'reached'
    at = world.controller.supervisor.executor.state.pose
    least = nearest_reachable(machine, goal).distance
    assert float(distance(machine, at, goal)) <= (1.0 + FARTHER[name]) * least
