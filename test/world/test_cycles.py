"""Cycles, pauses, the speed override and another pivot: nothing changes suddenly."""

import numpy as np
import pytest

from manipulator.pose import Pose
from world.requests import Requests

QUIET = 2.0
"""Counts: roundings, not motion."""

CIRCLE = [0.005, 0.005, 0.0, 0.0, 0.0, 0.0]
QUARTER = [0.0, np.pi / 2, 0.0, 0.0, 0.0, 0.0]


def changes(world, since):
    """The largest change of such a step to the next one."""
    return np.abs(np.diff(world.setpoints(since), 2, axis=0)).max(axis=1)


@pytest.fixture
def circling(world, ask):
    """The platform on a circle."""
    ask.cycle(CIRCLE, phase=QUARTER)
    world.wait('circle', lambda: world.status.mode == 'cycle')
    world.run(1.0)
    return world


@pytest.mark.parametrize('name', ['robocake', 'arm_6r_stepper'])
def test_a_cycle_swings_until_it_is_stopped(make_world, name):
    world = make_world(name)
    ask = Requests(world)
    ask.cycle()
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    swung = []
    for _ in range(250):
        world.run(0.01)
        swung.append(world.pose.position[0])
    assert np.ptp(swung) > 0.004
    assert world.status.result == 'moving'
    ask.stop()
    world.wait('rest', lambda: world.status.result == 'stopped')
    world.run(0.3)
    assert world.moved(world.now - 0.1) <= QUIET


def test_pause_and_speed_override_change_nothing_suddenly(circling, ask):
    usual, since = max(circling.steps(circling.now - 1.0)), circling.now
    for rate in (0.0, 1.0, 0.2, 1.0):
        ask.override(rate)
        circling.run(0.3)
    for is_paused in (True, False):
        ask.pause(is_paused)
        circling.run(0.4)
    assert max(circling.steps(since)) <= 1.2 * usual + QUIET
    assert max(changes(circling, since)) <= 0.5 * usual + QUIET
    assert circling.status.mode == 'cycle'


def test_a_paused_machine_stands_and_goes_on(circling, ask):
    ask.pause(True)
    circling.run(0.7)
    since = circling.now
    circling.run(1.0)
    assert circling.moved(since) <= QUIET
    ask.pause(False)
    circling.run(1.0)
    assert circling.moved(since) > 20.0


@pytest.mark.parametrize('depth', [0.05, -0.03])
def test_another_pivot_moves_nothing(world, ask, depth):
    tilted = Pose.from_xyz_rpy((0.003, 0.0, 0.044), (0.05, 0.0, 0.1))
    assert world.go_to(tilted).result == 'reached'
    world.run(0.3)
    since = world.now
    for z in (depth, 0.0):
        ask.pivot([0.0, 0.0, z])
        world.run(0.3)
    assert world.moved(since) <= QUIET


def test_goals_turn_about_the_pivot(world, ask):
    ask.pivot([0.0, 0.0, 0.03])
    world.run(0.1)
    supervisor = world.controller.supervisor
    above = supervisor.machine.frames.pivot(Pose.from_xyz_rpy((0.0, 0.0, 0.0412)))
    leaning = Pose.from_xyz_rpy(above.position, (0.1, 0.0, 0.0))
    assert world.go_to(supervisor.machine.frames.platform(leaning)).result == 'reached'
    world.run(0.3)
    assert world.pose.rpy[0] == pytest.approx(0.1, abs=5e-3)
    assert world.pose.position[1] == pytest.approx(0.03 * np.sin(0.1), abs=4e-4)


def test_home_is_where_the_machine_file_puts_it(world, ask):
    assert world.go_to(Pose.from_xyz_rpy((0.004, 0.0, 0.045))).result == 'reached'
    assert ask.home().result == 'reached'
    world.run(0.3)
    assert np.abs(world.pose.twist_to(world.machine.kinematics.home)).max() < 5e-3
