"""Paths, home, park, cycles and stops of the motion, from the user to the servos."""

import numpy as np
import pytest

from manipulator.planning.cycle import Cycle
from manipulator.pose import Pose
from manipulator.trajectory.path_planning import OVERTAKEN

HIGHER = Pose.from_xyz_rpy((0.0, 0.0, 0.0452))
RADIUS, HEIGHT = 0.006, 0.043


def circle(count=120, radius=RADIUS):
    angle = np.linspace(0.0, 2 * np.pi, count)
    ring = [radius * np.cos(angle), radius * np.sin(angle), np.full(count, HEIGHT)]
    return Pose(np.stack(ring, axis=1), np.eye(3))


def results(world, stamp):
    return [s.result for _, s in world.controller.statuses if s.goal_stamp == stamp]


def test_a_path_is_driven_within_half_a_millimetre(world):
    assert world.go_to(circle()[0]).result == 'reached'
    stamp, points = world.send_path(circle()), []

    def is_over():
        points.append(world.pose.position)
        return results(world, stamp)[-1:] == ['reached']

    world.wait('end of the path', is_over)
    points = np.array(points)
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - RADIUS).max() < 5e-4
    assert np.abs(points[:, 2] - HEIGHT).max() < 5e-4
    turned = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert np.ptp(turned) > 0.95 * 2 * np.pi


def test_a_path_stops_on_its_path(world):
    stamp = world.send_path(circle())
    world.wait('path', lambda: world.status.mode == 'path')
    world.run(0.2)
    world.controller.core.stop()
    assert world.end_of(stamp).result == 'stopped'
    world.run(0.3)
    x, y, z = world.pose.position
    assert np.hypot(x, y) == pytest.approx(RADIUS, abs=5e-4)
    assert z == pytest.approx(HEIGHT, abs=5e-4)


def test_a_goal_takes_the_place_of_a_path_that_is_worked_out(world):
    world.controller.thread.seconds = 1.0
    stamp = world.send_path(circle())
    world.wait('planning', lambda: world.status.result == 'planning')
    assert world.go_to(HIGHER).result == 'reached'
    assert results(world, stamp) == ['planning', 'stopped']
    assert OVERTAKEN in [s.reason for _, s in world.controller.statuses]
    world.run(2.0)
    assert world.status.mode == 'hold'


def test_a_path_beyond_the_reach_is_refused_and_nothing_moves(world):
    since = world.now
    refused = world.end_of(world.send_path(circle(radius=0.05)))
    assert refused.result == 'refused'
    assert 'leg' in refused.reason
    assert world.moved(since) <= 2.0


@pytest.mark.parametrize('delay', [0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.1])
def test_what_is_asked_right_after_the_clear_is_driven(world, delay):
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    assert world.clear() == ''
    world.run(delay)
    assert world.go_to(HIGHER).result == 'reached'
    assert not world.controller.on_goal.refusals


def test_a_goal_from_before_the_clear_moves_nothing(world):
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    assert 'clear the stop first' in world.go_to(HIGHER).reason
    since = world.now
    assert world.clear() == ''
    world.run(1.0)
    assert world.moved(since) <= 2.0


def test_a_goal_that_waits_for_the_machine_is_refused_by_the_next_stop(world):
    world.emergency_stop()
    world.wait('stop', lambda: world.state == 'stopped')
    world.links['joints'].loses = world.links['pose'].loses = lambda: True
    assert world.clear() == ''
    world.run(0.05)
    stamp = world.send_goal(HIGHER)
    world.run(0.1)
    assert results(world, stamp) == []
    world.emergency_stop()
    refused = world.end_of(stamp)
    assert (refused.result, 'clear the stop first' in refused.reason) == ('refused', True)


@pytest.mark.parametrize('name', ['robocake', 'arm_6r'])
def test_park_and_home_arrive_and_the_machine_is_there(make_world, name):
    world = make_world(name)
    core, kinematics = world.controller.core, world.machine.kinematics
    core.park(1.0, world.now)
    assert world.end_of(1.0).result == 'reached'
    core.home(2.0, world.now)
    assert world.end_of(2.0).result == 'reached'
    world.run(0.3)
    assert np.abs(world.pose.twist_to(kinematics.home)[:3]).max() < 3e-3


def test_a_cycle_runs_until_it_is_stopped(world):
    core = world.controller.core
    size, frequency, phase = np.full(6, 1e-3), np.full(6, 0.5), np.zeros(6)
    core.start_cycle(lambda centre: Cycle(centre, size, frequency, phase), 3.0)
    world.wait('answer', lambda: core.cycle_answer(3.0) is not None)
    assert core.cycle_answer(3.0).is_obeyed
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    world.run(2.0)
    pulses = world.pulses(world.now - 2.0)
    assert np.ptp(pulses, axis=0)[:6].max() > 20.0
    core.stop()
    world.wait('stop', lambda: world.status.result == 'stopped')
    world.run(0.3)
    still = world.pulses(world.now - 0.2)
    assert np.nanmax(np.abs(still - still[0])) <= 2.0
