"""Boards that go away, fall silent or run out of power: what is said, and nothing by itself."""

import numpy as np
import pytest

from bridge.fake.faults import FaultKind
from bridge.protocol import Setpoint
from manipulator.pose import Pose
from world.faulty_line import FaultyLine

FAR = Pose.from_xyz_rpy((0.010, 0.0, 0.0412))
NEAR = Pose.from_xyz_rpy((0.0, 0.0, 0.043))
QUIET = 2.0
"""Counts: roundings, not motion."""


@pytest.fixture
def line(world):
    """On its way, with a line that fails on request."""
    line = FaultyLine(world, seed=0, per_minute=0.0)
    world.send_goal(FAR)
    world.run(0.12)
    return line


def assert_still(world, seconds=1.0):
    since = world.now
    world.run(seconds)
    pulses = world.pulses(since)
    is_off = np.isnan(pulses)
    assert (is_off == is_off[0]).all()
    assert is_off.all() or np.nanmax(np.abs(pulses - pulses[0])) <= QUIET


def words(world):
    return [word for _, (word, *_) in world.bridge.states]


@pytest.mark.parametrize(
    ('kind', 'text'),
    [(FaultKind.UNPLUG, 'disconnected'), (FaultKind.RESET, 'disarmed')],
)
def test_a_board_that_was_away_comes_back_disarmed(world, line, kind, text):
    line.inject(kind)
    world.wait(text, lambda: world.state == text)
    world.wait('board', lambda: world.state == 'disarmed')
    assert_still(world)
    world.enable()
    assert world.go_to(NEAR).result == 'reached'


def test_a_board_with_another_program_is_not_driven_and_the_right_one_is(world, line):
    line.inject(FaultKind.VERSION)
    world.wait('word', lambda: 'has protocol 2, this host 1' in world.bridge.monitor.problem)
    since = world.now
    world.run(1.0)
    assert world.frames(Setpoint, since) == []
    world.wait('board', lambda: world.state == 'disarmed')
    world.enable()
    assert world.go_to(NEAR).result == 'reached'


def test_a_board_that_fell_silent_holds_and_must_be_asked_again(world, line):
    line.inject(FaultKind.MUTE)
    world.wait('word', lambda: world.state == 'disconnected')
    world.wait('board', lambda: world.state == 'unclaimed')
    assert_still(world)
    before = world.pulses(world.now - 0.1)[-1]
    assert world.ask_to_arm().said is None
    world.wait('enabled', lambda: world.state == 'enabled')
    assert np.nanmax(np.abs(world.pulses(world.now - 0.1)[-1] - before)) <= QUIET
    world.wait('hold', lambda: world.status.mode == 'hold')
    assert world.go_to(NEAR).result == 'reached'


def test_an_empty_battery_stops_and_is_not_cleared_before_it_is_full(world, line):
    line.inject(FaultKind.UNDERVOLTAGE)
    world.wait('fault', lambda: world.state == 'fault')
    assert 'the battery is too low' in world.bridge.monitor.status.reason
    assert 'the battery is too low' in world.clear()
    assert_still(world, 2.0)
    assert world.clear() == ''
    assert_still(world)
    world.wait('hold', lambda: world.status.mode == 'hold')
    assert world.go_to(NEAR).result == 'reached'


def test_an_open_stop_contact_stops_and_cannot_be_cleared_until_it_is_closed(world, line):
    board = world.board.machine.board
    board.is_stop_open = True
    world.wait('stop', lambda: world.state == 'stopped')
    assert world.clear() != ''
    board.is_stop_open = False
    assert_still(world)
    assert world.state == 'stopped'
    assert world.clear() == ''
    assert_still(world)
    world.wait('hold', lambda: world.status.mode == 'hold')
    assert world.go_to(NEAR).result == 'reached'


@pytest.mark.parametrize('kind', [FaultKind.DROP, FaultKind.DELAY, FaultKind.CORRUPT])
def test_a_bad_line_in_motion_breaks_no_limit_and_the_next_goal_works(world, line, kind):
    line.inject(kind)
    world.run(2.0)
    steps = np.abs(np.diff(world.pulses(), axis=0))
    most = np.array(world.board.machine.board.settings.count_speeds) * 0.02 + 1.0
    assert not (steps > most).any()
    if world.state != 'enabled':
        world.enable()
    world.wait('hold', lambda: world.status.mode in ('hold', 'move'))
    assert world.go_to(NEAR).result == 'reached'


def test_a_disconnected_board_cannot_be_enabled(world, line):
    world.cable.pull()
    world.wait('word', lambda: world.state == 'disconnected')
    assert 'no board' in world.ask(lambda driver: driver.enable(True))


def test_joints_that_are_not_known_are_not_reported(world, line):
    world.disable()
    world.wait('release', lambda: world.status.mode == 'disabled')
    reported = []
    world.links['joints'].lead_to(world.user, lambda stamp, joints: reported.append(joints))
    world.run(1.0)
    assert reported == []
