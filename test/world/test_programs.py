"""Programs that the board plays by itself: uploaded over the line, and what ends them."""

import numpy as np
import pytest

from bridge.fake.faults import FaultKind
from bridge.programs import count_table
from bridge.protocol import CycleAxis, Finish, Play, Program, Setpoint, TableBegin
from world.faulty_line import FaultyLine

QUIET = 2.0
PERIOD = 2.0
AXES = [CycleAxis(k, a, 1000, 0.0) for k, a in enumerate((0.0, 0.0, 0.002, 0.0, 0.0, 0.03))]


def swing(world, rows=20):
    """Two seconds about where the cranks are, as commands."""
    times, turns = np.arange(rows) * PERIOD / rows, 2 * np.pi * np.arange(rows) / rows
    joints = world.board.machine.servos.positions + np.radians(3.0) * np.sin(turns)[:, None]
    return count_table(times, joints, world.calibration).upload


def done(world, commands):
    """What became of them: '' where all were obeyed."""
    answer = world.bridge.send_all(commands)
    world.wait('answer', lambda: answer.said is not None)
    return answer.said


@pytest.fixture
def playing(world):
    """A hexapod whose board plays a table in a loop."""
    assert done(world, swing(world)) == ''
    assert done(world, [Play(Program.TABLE, True)]) == ''
    world.wait('program', lambda: world.state == 'playing')
    world.run(2.0)
    return world


def test_a_table_is_played_by_the_board_alone_and_finished_at_rest(playing):
    since = playing.now
    playing.run(PERIOD)
    assert np.ptp(playing.pulses(since), axis=0).min() > 50
    assert playing.frames(Setpoint, since) == []
    assert done(playing, [Finish()]) == ''
    playing.wait('enabled machine', lambda: playing.state == 'enabled')
    playing.run(0.3)
    assert playing.moved(playing.now - 0.2) <= QUIET
    assert playing.go_to(playing.machine.kinematics.home).result == 'reached'


def test_it_goes_on_while_the_bridge_is_dead_and_another_bridge_stops_it(playing):
    since = playing.now
    playing.restart('bridge')
    playing.run(2.0)
    assert np.ptp(playing.pulses(playing.now - 1.0), axis=0).min() > 20
    assert playing.state == 'playing'
    assert playing.ask(lambda driver: driver.stop()) == ''
    playing.run(0.2)
    assert playing.moved(playing.now - 0.1) <= QUIET
    assert playing.frames(Setpoint, since) == []


def test_goals_and_jogs_move_nothing_while_it_plays_nor_after_a_stop(playing):
    home = playing.machine.kinematics.home
    since = playing.now
    playing.send_goal(home.moved(np.array([0.005, 0, 0, 0, 0, 0])))
    playing.jog([0.01, 0, 0, 0, 0, 0], 0.3)
    assert playing.frames(Setpoint, since) == []
    playing.emergency_stop()
    playing.wait('stop', lambda: playing.state == 'stopped')
    playing.run(0.2)
    held = playing.now
    playing.run(1.0)
    assert playing.clear() == ''
    playing.run(1.0)
    assert playing.moved(held) <= QUIET
    assert playing.go_to(home).result == 'reached'


@pytest.mark.parametrize('kind', [FaultKind.DROP, FaultKind.CORRUPT, FaultKind.DUPLICATE])
def test_over_a_bad_line_a_table_is_on_board_whole_or_not_at_all(world, kind):
    line, table = FaultyLine(world, 5, 0.0), swing(world)
    upload = world.bridge.send_all(table)
    for _ in range(4):
        world.run(0.02)
        line.inject(kind)
        world.run(0.5)
    world.wait('answer', lambda: upload.said is not None)
    played = done(world, [Play(Program.TABLE, False)])
    assert (played == '') == (upload.said == '')
    if played == '':
        world.wait('program', lambda: world.state == 'playing')
        since = world.now
        world.wait('its end', lambda: world.state == 'enabled')
        ends = [begin.counts for begin in table[1:-1]]
        reached = world.pulses(since)
        assert reached.max(axis=0) == pytest.approx(np.max(ends, axis=0), abs=5)
        assert reached.min(axis=0) == pytest.approx(np.min(ends, axis=0), abs=5)


def test_a_table_that_was_begun_and_not_sealed_is_not_played(world):
    begin, *rows, _ = swing(world)
    assert isinstance(begin, TableBegin)
    assert done(world, [begin, *rows]) == ''
    assert 'no such program' in done(world, [Play(Program.TABLE, False)])


def test_a_cycle_that_no_servo_can_follow_is_refused_before_anything_moves(world):
    since = world.now
    assert done(world, [*AXES[:2], CycleAxis(2, 0.03, 1000, 0.0), *AXES[3:]]) == ''
    done(world, [Play(Program.CYCLE, False)])
    world.run(2.0)
    assert 'too fast' in world.bridge.troubles[-1][1]
    assert world.moved(since) <= QUIET
    assert done(world, [*AXES, Play(Program.CYCLE, False)]) == ''
    world.wait('program', lambda: world.state == 'playing')
    world.wait('its end', lambda: world.state == 'enabled')
