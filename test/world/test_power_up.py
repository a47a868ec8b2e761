"""Power-up, resets and enabling: nothing moves unasked, and nothing jumps."""

import itertools

import numpy as np
import pytest

from bridge.protocol import Arm, ResetCause, Setpoint
from manipulator.pose import Pose
from world.world import World

GOAL = Pose.from_xyz_rpy((0.006, 0.0, 0.045), (0.0, 0.05, 0.0))
MACHINES = ['robocake', 'stewart_6_6', 'arm_6r', 'arm_6r_stepper']


def park_of(world):
    return np.array(world.calibration.counts(world.calibration.park))


def nearest_goal(world):
    length = world.machine.kinematics.characteristic_length
    return world.machine.kinematics.home.moved(0.03 * length * np.array([1, 0, -1, 0, 0, 0]))


@pytest.mark.parametrize('name', MACHINES)
def test_nothing_is_sent_and_no_pulse_goes_out_before_somebody_enables(name):
    world = World(name)
    world.wait('board', lambda: world.state == 'disarmed')
    world.run(5.0)
    assert world.frames() == []
    assert np.isnan(world.pulses()).all()


@pytest.mark.parametrize('name', MACHINES)
def test_an_enabled_machine_stays_at_park_until_its_first_goal(make_world, name):
    world = make_world(name)
    world.run(1.0)
    (_, first), *_ = world.frames()
    assert isinstance(first, Arm)
    assert list(first.park) == park_of(world).tolist()
    assert np.abs(world.setpoints() - park_of(world)).max() <= 1.0


def test_servos_are_switched_on_one_by_one(world):
    times = np.array([t for t, _ in world.board.pulses])
    on = np.isfinite(world.pulses()).sum(axis=1)
    assert (np.diff(on) >= 0).all()
    first = [times[on >= count][0] for count in range(1, 7)]
    assert np.diff(first) == pytest.approx(0.15, abs=0.03)


@pytest.mark.parametrize('name', MACHINES)
def test_a_goal_is_driven_without_a_jump(make_world, name):
    world = make_world(name)
    assert world.go_to(nearest_goal(world)).result == 'reached'
    limits = np.array(world.board.machine.board.settings.count_speeds) * 0.01
    steps = [np.abs(b - a) for a, b in itertools.pairwise(world.setpoints())]
    assert (np.array(steps) <= limits + 1.0).all()
    assert np.abs(world.setpoints()[-1] - park_of(world)).max() > 20


@pytest.mark.parametrize('cause', ResetCause)
def test_a_board_that_starts_again_in_motion_is_silent_until_it_is_enabled(world, cause):
    world.send_goal(GOAL)
    world.run(0.12)
    world.board.machine.board.reset(cause)
    world.wait('reset', lambda: world.state != 'enabled')
    world.wait('board', lambda: world.state == 'disarmed')
    since = world.now
    world.run(2.0)
    assert world.frames((Setpoint, Arm), since) == []
    assert np.isnan(world.pulses(since)).all()
    world.enable()
    assert np.abs(world.setpoints(since) - park_of(world)).max() <= 1.0
    assert world.go_to(GOAL).result == 'reached'


def test_disabling_ends_all_pulses(world):
    assert world.disable() == ''
    world.run(0.1)
    since = world.now
    world.run(1.0)
    assert np.isnan(world.pulses(since)).all()
    assert world.frames(Setpoint, since) == []
    assert world.state == 'disarmed'
