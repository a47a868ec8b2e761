"""Paths: driven exactly, approached first, refused as a whole, replaced by newer goals."""

import numpy as np
import pytest

from manipulator.planning.path import arc
from manipulator.pose import Pose

RADIUS, HEIGHT = 0.008, 0.045
NEAR = 5e-4


def circle(count, turns=1.0):
    angle = np.linspace(0.0, 2 * np.pi * turns, count)
    ring = [RADIUS * np.cos(angle), RADIUS * np.sin(angle), np.full(count, HEIGHT)]
    return Pose(np.stack(ring, axis=1), np.eye(3))


def end_of(world, stamp, seconds=60.0):
    """Positions (n, 3) and statuses until something came of it."""
    seen, ends = [], ('reached', 'refused', 'stopped')
    since = len(world.controller.statuses)

    def is_over():
        seen.append(world.pose.position)
        return world.status.goal_stamp == stamp and world.status.result in ends

    world.wait('end of the path', is_over, seconds)
    return np.array(seen), [status for _, status in world.controller.statuses[since:]]


def off_circle(points):
    return np.abs(np.hypot(points[:, 0], points[:, 1]) - RADIUS).max()


def test_a_circle_is_driven_within_half_a_millimetre_around_the_whole_path(world, ask):
    assert world.go_to(circle(120)[0]).result == 'reached'
    world.run(0.3)
    points, statuses = end_of(world, ask.path(circle(120)))
    assert (statuses[-1].mode, statuses[-1].result) == ('hold', 'reached')
    assert off_circle(points) < NEAR
    assert np.abs(points[:, 2] - HEIGHT).max() < NEAR
    turned = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert np.ptp(turned) > 0.98 * 2 * np.pi


def test_a_path_from_elsewhere_is_approached_first_and_its_progress_reported(world, ask):
    _, statuses = end_of(world, ask.path(circle(200, turns=3.0)))
    results = [status.result for status in statuses]
    assert results[0] == 'planning'
    modes = [status.mode for status in statuses if status.result == 'moving']
    assert modes == sorted(modes, key=['move', 'path'].index)
    percents = [s.percent for s in statuses if s.mode == 'path' and s.percent is not None]
    assert percents == sorted(percents)
    assert len(set(percents)) >= 4


@pytest.mark.parametrize('count', [1, 5])
def test_one_pose_or_the_same_repeated_is_a_goal(world, ask, count):
    goal = Pose(np.tile([0.003, 0.0, 0.044], (count, 1)), np.tile(np.eye(3), (count, 1, 1)))
    _, statuses = end_of(world, ask.path(goal))
    assert statuses[-1].result == 'reached'
    assert 'path' not in {status.mode for status in statuses}
    world.run(0.3)
    assert np.abs(world.pose.position - goal.position[0]).max() < NEAR


def test_what_cannot_be_driven_is_refused_with_pose_leg_and_limit_before_anything_moves(
    world, ask
):
    since = world.now
    far = arc(Pose.from_xyz_rpy((0.0, 0.0, 0.0412)), (0.05, 0, 0.0412), (0, 0, 1), 1.0)
    _, statuses = end_of(world, ask.path(far))
    assert statuses[-1].result == 'refused'
    assert 'm along the path: leg' in statuses[-1].reason
    pulses = world.pulses(since)
    assert np.abs(pulses - pulses[0]).max() <= 1.0
    assert world.go_to(circle(1)[0]).result == 'reached'


def test_a_newer_goal_takes_the_place_of_a_path_that_is_being_worked_out(world, ask):
    ask.path(circle(500), seconds=1.0)
    world.run(0.2)
    assert world.status.result == 'planning'
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.046))).result == 'reached'
    world.run(2.0)
    assert (world.status.mode, world.status.result) == ('hold', 'reached')
    assert world.pose.position[0] == pytest.approx(0.0, abs=NEAR)


def test_a_newer_goal_takes_the_place_of_a_path_that_is_driven(world, ask):
    ask.path(circle(120))
    world.wait('path', lambda: world.status.mode == 'path')
    world.run(0.3)
    assert world.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.046))).result == 'reached'


def test_a_path_stops_on_its_path_and_obeys_the_speed_override(world, ask):
    assert world.go_to(circle(2)[0]).result == 'reached'
    ask.override(0.2)
    stamp = ask.path(circle(120))
    world.wait('path', lambda: world.status.mode == 'path')
    world.timeline.after(1.5, ask.stop)
    points, statuses = end_of(world, stamp)
    assert statuses[-1].result == 'stopped'
    assert off_circle(points) < NEAR
    turned = np.ptp(np.unwrap(np.arctan2(points[:, 1], points[:, 0])))
    speed = world.machine.motion.linear.speed
    assert 0.5 * turned < 0.2 * speed * 1.6 / RADIUS < 2.0 * turned


def test_a_path_that_is_worked_out_while_the_machine_is_lost_is_not_driven(world, ask):
    ask.path(circle(120), seconds=0.5)
    world.run(0.1)
    world.cable.pull()
    world.run(0.2)
    world.cable.plug()
    world.wait('board', lambda: world.state == 'disarmed')
    world.enable()
    since = world.now
    world.run(2.0)
    assert world.moved(since) <= 2.0
