"""Processes that freeze, die or come late: the machine holds, and nothing jumps or resumes."""

import numpy as np
import pytest

from manipulator.deadlines import POSE_DEADLINE
from manipulator.pose import Pose
from sampling import enough

FAR = Pose.from_xyz_rpy((0.010, 0.0, 0.0412))
HIGHER = Pose.from_xyz_rpy((0.0, 0.0, 0.0452))
PROCESSES = ['controller', 'inverse', 'forward', 'bridge']


def test_a_tick_that_was_frozen_for_too_long_reports_no_setpoint(world):
    world.send_goal(HIGHER)
    world.wait('motion', lambda: world.pose.position[2] > 0.0422)
    before = world.now
    world.controller.pause_in_next_tick = POSE_DEADLINE + 0.1
    world.run(POSE_DEADLINE + 0.05)
    frozen = world.setpoints(before)
    world.run(2.0)
    late = world.setpoints(before)[len(frozen) :]
    assert max(world.controller.ages) < POSE_DEADLINE
    assert world.status.result != 'reached'
    assert np.abs(late - late[0]).max() <= 2.0


@pytest.mark.parametrize('name', PROCESSES)
def test_a_process_that_is_started_again_moves_nothing_and_takes_goals(world, name):
    world.send_goal(FAR)
    world.run(0.12)
    world.restart(name)
    world.run(3.0)
    since = world.now
    world.run(1.0)
    still = world.pulses(since)
    assert np.nanmax(np.abs(still - still[0])) <= 2.0
    world.enable()
    assert world.go_to(HIGHER).result == 'reached'


@pytest.mark.parametrize('name', PROCESSES)
@pytest.mark.parametrize('seconds', enough([0.1, 0.3], [0.1, 0.3, 1.0, 3.0]))
def test_a_frozen_process_breaks_no_limit(world, name, seconds):
    world.send_goal(FAR)
    world.run(0.12)
    getattr(world, name).freeze(seconds)
    world.run(seconds + 1.5)
    assert_within_limits(world)
    world.enable()
    assert world.go_to(HIGHER).result == 'reached'


@pytest.mark.parametrize('name', ['inverse', 'bridge'])
@pytest.mark.parametrize('seconds', enough([0.15, 0.3], [0.15, 0.25, 0.35, 0.45]))
def test_a_goal_whose_last_commands_are_lost_is_not_reported_as_reached(world, name, seconds):
    world.send_goal(FAR)
    world.run(0.2)
    getattr(world, name).freeze(seconds)
    world.wait('result', lambda: world.status.result in ('reached', 'stopped'))
    there = world.calibration.counts(world.machine.kinematics.inverse(FAR))
    gap = np.abs(world.pulses()[-1] - there).max()
    assert world.status.result == ('reached' if gap <= 2.0 else 'stopped')
    world.wait('controller that holds', lambda: world.status.mode == 'hold')
    assert world.go_to(HIGHER).result == 'reached'


@pytest.mark.parametrize('name', PROCESSES)
@pytest.mark.parametrize('step', [-3600.0, 3600.0])
def test_the_clock_of_one_computer_is_set_and_the_motion_goes_on(world, ask, name, step):
    ask.cycle()
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    for offset in (step, 0.0):
        getattr(world, name).clock_offset = offset
        words, since = len(world.bridge.states), world.now
        world.run(0.8)
        assert world.status.mode == 'cycle'
        assert len(world.bridge.states) == words
        assert np.ptp(world.pulses(since), axis=0).max() > 20.0


@pytest.mark.parametrize('name', PROCESSES)
def test_a_process_that_ends_for_good_stops_the_machine(world, ask, name):
    ask.cycle()
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    getattr(world, name).kill()
    world.run(1.5)
    since = world.now
    world.run(1.0)
    assert world.moved(since) <= 2.0


@pytest.mark.parametrize('name', PROCESSES)
def test_a_frozen_process_stops_the_machine_and_nothing_jumps_when_it_goes_on(world, ask, name):
    ask.cycle()
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    getattr(world, name).freeze(3.0)
    world.run(1.5)
    since = world.now
    world.run(3.0)
    assert world.moved(since) <= 2.0


@pytest.mark.parametrize(
    ('name', 'ends', 'bridge'),
    [
        ('forward', 0.535, (0.08, 1.22)),
        ('forward', 0.583, (0.12, 0.90)),
        ('forward', 0.477, (0.07, 1.06)),
        ('controller', 0.459, (0.005, 0.665)),
        ('controller', 0.344, (0.03, 0.92)),
        ('inverse', 0.4, (0.03, 0.92)),
    ],
)
@pytest.mark.parametrize('wait', enough([0.73], [0.0, 0.17, 0.31, 0.73, 0.89, 0.97]))
def test_two_processes_that_freeze_together_move_nothing_when_they_go_on(
    world, ask, name, ends, bridge, wait
):
    """What each of them sends late is of a time when the machine still moved."""
    ask.cycle()
    world.wait('cycle', lambda: world.status.mode == 'cycle')
    world.run(0.7 + wait)
    getattr(world, name).freeze(ends)
    begins, goes_on = bridge
    world.run(begins)
    world.bridge.freeze(goes_on - begins)
    world.run(0.4)
    since = world.now
    world.run(3.0)
    assert world.moved(since) <= 2.0


def test_cable_pulled_and_put_back_needs_enable_and_nothing_resumes(world):
    world.send_goal(FAR)
    world.run(0.12)
    world.cable.pull()
    world.wait('word', lambda: world.state == 'disconnected')
    world.run(1.0)
    world.cable.plug()
    world.wait('board', lambda: world.state == 'disarmed')
    world.run(1.0)
    assert np.isnan(world.pulses(world.now - 0.5)).all()
    world.enable()
    assert world.go_to(HIGHER).result == 'reached'
    assert_within_limits(world)


def test_a_stuck_joint_that_is_measured_is_named_and_the_goal_dropped(make_world):
    world = make_world('arm_6r_stepper')
    kinematics = world.machine.kinematics
    turned = kinematics.inverse(kinematics.home) + 0.6 * np.eye(6)[0]
    world.board.stuck_channel = 0
    there = world.go_to(kinematics.forward(turned).pose)
    assert there.result == 'stopped'
    assert f'{kinematics.joint_names[0]} is ' in there.reason


def assert_within_limits(world):
    """Every frame within the counts' ranges, every pulse within what its servo can follow."""
    settings = world.board.machine.board.settings
    counts, ranges = world.setpoints(), np.array(settings.count_ranges)
    assert (counts >= ranges[:, 0]).all()
    assert (counts <= ranges[:, 1]).all()
    changes = np.abs(np.diff(world.pulses(), axis=0))
    most = np.array(settings.count_speeds) * 0.02 + 1.0
    assert not (changes > most).any()
