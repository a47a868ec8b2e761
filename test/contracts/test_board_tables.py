"""What every board does with a table of counts: takes it row by row, plays it, refuses it."""

import math

import numpy as np
import pytest

from bridge.frames import table_crc
from bridge.protocol import (
    Arm,
    Disarm,
    FaultCode,
    Finish,
    Mode,
    Play,
    Program,
    Result,
    Setpoint,
    Stop,
    TableBegin,
    TableEnd,
    TableRow,
)

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
MOVED = tuple(count + 20 for count in PARK)
ARMED = (Mode.ARMED, Mode.HOLDING)  # it waits 2 s for a host, then holds
STEP = 252  # counts that a servo can do in one pulse period
WAVE = [
    tuple(round(c + 150 * math.sin(math.pi * k / 20)) for c in PARK) for k in range(41)
]  # 2 s at 50 ms, from PARK and back to it


@pytest.fixture
def loaded(armed):
    """Armed, with WAVE uploaded."""
    assert armed.upload(WAVE) is Result.OK
    return armed


def test_a_table_is_played_once_smoothly_and_ends_at_its_last_row(loaded):
    assert loaded.ask(Play(Program.TABLE, False)) is Result.OK
    modes, counts = loaded.record(5.0)
    assert modes[0] in (Mode.CHECKING, Mode.PLAYING)
    assert modes[-1] in ARMED
    assert tuple(counts[-1]) == WAVE[-1]
    way = counts[:, 0] - PARK[0]
    assert way.max() == pytest.approx(150, abs=3)
    assert way.min() == pytest.approx(-150, abs=3)
    speed = np.abs(np.diff(way))
    assert speed.max() <= 12  # 150 · π counts a second, in 20 ms
    moving = np.flatnonzero(speed)
    assert speed[moving[:3]].max() <= 2
    assert speed[moving[-3:]].max() <= 2


def test_a_loop_goes_on_without_a_host_until_it_is_finished_smoothly(loaded):
    loaded.ask(Play(Program.TABLE, True))
    modes, counts = loaded.record(12.0)
    assert set(modes[5:]) == {Mode.PLAYING}
    # 41 rows, 50 ms apart, the way back to the first one included: twice that is 205 periods.
    assert np.abs(counts[355:] - counts[150:-205]).max() <= 1
    assert np.ptp(counts[150:, 0]) == pytest.approx(300, abs=2)
    assert loaded.ask(Finish()) is Result.OK
    modes, counts = loaded.record(2.0)
    assert modes[-1] in ARMED
    speed = np.abs(np.diff(counts[:, 0]))
    assert speed.max() <= 12
    assert np.abs(np.diff(speed)).max() <= 3
    assert speed[-10:].max() == 0


@pytest.mark.parametrize(('on_link_loss', 'mode'), [('hold', 'HOLDING'), ('release', 'DISARMED')])
def test_after_a_program_a_board_that_nobody_drives_does_what_its_machine_says(
    make_driver, on_link_loss, mode
):
    driver = make_driver(on_link_loss=on_link_loss)
    driver.arm()
    driver.send(Setpoint(2000, PARK))
    assert driver.upload([PARK, MOVED, PARK], 100) is Result.OK
    assert driver.ask(Play(Program.TABLE, False)) is Result.OK
    modes, counts = driver.record(4.0)
    assert set(modes[:5]) <= {Mode.CHECKING, Mode.PLAYING}
    assert Mode.ARMED in modes
    assert tuple(counts[modes.index(Mode.ARMED) + 50]) == PARK
    driver.run(1.5)
    assert driver.state().mode is Mode[mode]


def test_a_table_that_did_not_arrive_whole_is_not_played(armed):
    armed.ask(TableBegin(3, 50))
    assert armed.ask(TableRow(0, PARK)) is Result.OK
    assert armed.ask(TableRow(2, PARK)) is Result.BAD_TABLE
    assert armed.ask(TableEnd(table_crc([PARK]))) is Result.BAD_TABLE
    assert armed.ask(TableRow(1, PARK)) is Result.OK
    assert armed.ask(TableRow(2, PARK)) is Result.OK
    assert armed.ask(TableRow(3, PARK)) is Result.BAD_TABLE
    assert armed.ask(TableEnd(table_crc([PARK] * 3) ^ 1)) is Result.BAD_TABLE
    assert armed.ask(Play(Program.TABLE, False)) is Result.NO_PROGRAM
    assert armed.ask(TableEnd(table_crc([PARK] * 3))) is Result.OK
    assert armed.ask(Play(Program.TABLE, False)) is Result.OK


def test_a_row_that_is_repeated_because_its_answer_was_lost_counts_once(armed):
    armed.ask(TableBegin(2, 50))
    sequence = armed.send(TableRow(0, PARK))
    armed.run(0.04)
    assert armed.ask(TableRow(0, PARK), sequence) is Result.OK
    assert armed.ask(TableRow(1, PARK)) is Result.OK
    assert armed.ask(TableEnd(table_crc([PARK] * 2))) is Result.OK


def test_a_table_larger_than_the_memory_is_refused(armed):
    assert armed.ask(TableBegin(449, 50)) is Result.TOO_LARGE
    assert armed.ask(TableBegin(448, 50)) is Result.OK


def test_a_steep_table_that_is_played_once_ends_exactly_at_its_last_row(armed):
    there = tuple(count + 240 for count in PARK)
    assert armed.upload([PARK, there], 20) is Result.OK
    assert armed.ask(Play(Program.TABLE, False)) is Result.OK
    armed.run(4.0)
    assert armed.counts() == there


def test_the_joints_take_half_a_second_to_the_first_row_slow_fast_slow(armed):
    there = tuple(count + 100 for count in PARK)
    assert armed.upload([there, there]) is Result.OK
    assert armed.ask(Play(Program.TABLE, True)) is Result.OK
    _, counts = armed.record(1.0)
    moved = counts[:, 0] - PARK[0]
    start = np.flatnonzero(moved)[0] - 1
    shares = np.arange(26) / 25
    expected = 100 * shares**2 * (3 - 2 * shares)
    seen = moved[max(start, 0) : max(start, 0) + 26]
    shifts = [np.abs(np.roll(expected, k)[3:-3] - seen[3:-3]).max() for k in (-2, -1, 0, 1)]
    assert min(shifts) < 1.0
    assert moved[-1] == 100


@pytest.mark.parametrize(('joints', 'rows'), [(6, 448), (8, 336)])
def test_the_largest_table_is_taken_to_its_last_count_and_played(make_driver, joints, rows):
    ranges, speeds = ((1100, 4900),) * joints, (12_600.0,) * joints
    driver = make_driver(count_ranges=ranges, count_speeds=speeds, hexapod=None)
    table = [tuple(3000 + (7 * k + i) % 100 for i in range(joints)) for k in range(rows)]
    driver.arm(table[0])
    assert driver.upload(table) is Result.OK
    assert driver.ask(Play(Program.TABLE, True)) is Result.OK
    driver.run(1.0)
    assert driver.state().mode is Mode.PLAYING


@pytest.mark.parametrize(('rows', 'step_ms'), [(0, 50), (1, 50), (2, 19), (2, 0)])
def test_a_table_without_way_or_time_is_refused(armed, rows, step_ms):
    assert armed.ask(TableBegin(rows, step_ms)) is Result.BAD_TABLE


def test_rows_are_checked_as_setpoints_are(armed):
    armed.ask(TableBegin(2, 50))
    assert armed.ask(TableRow(0, (1099, *PARK[1:]))) is Result.OUT_OF_RANGE
    assert armed.ask(TableRow(0, PARK[:5])) is Result.WRONG_JOINTS
    assert armed.ask(TableRow(0, PARK)) is Result.OK


def test_a_table_that_servos_cannot_follow_is_refused_whole(armed):
    far = tuple(count + STEP + 1 for count in PARK)
    armed.upload([PARK, far], 20)
    assert armed.ask(Play(Program.TABLE, False)) is Result.TOO_FAST
    slow = tuple(count + STEP for count in PARK)
    armed.upload([PARK, slow], 20)
    assert armed.ask(Play(Program.TABLE, False)) is Result.OK


def test_the_way_back_to_the_first_row_counts_in_a_loop(armed):
    rows = [tuple(count + 200 * k for count in PARK) for k in range(3)]
    armed.upload(rows, 20)
    assert armed.ask(Play(Program.TABLE, True)) is Result.TOO_FAST
    assert armed.ask(Play(Program.TABLE, False)) is Result.OK


def test_a_program_that_begins_elsewhere_is_refused(armed):
    rows = [tuple(count + 121 for count in row) for row in WAVE]
    armed.upload(rows)
    assert armed.ask(Play(Program.TABLE, False)) is Result.NOT_AT_START
    _, counts = armed.record(0.2)
    assert set(map(tuple, counts.tolist())) == {PARK}


def test_nothing_is_played_while_disarmed_or_stopped(loaded):
    loaded.ask(Stop())
    assert loaded.ask(Play(Program.TABLE, False)) is Result.STOPPED
    loaded.ask(Disarm())
    loaded.reset()
    loaded.run(0.4)
    assert loaded.ask(Play(Program.TABLE, False)) is Result.NOT_ARMED


@pytest.mark.parametrize('program', [0, Program.CYCLE, Program.FLASH_TABLE, 4, 255])
def test_programs_that_are_not_there_are_refused(loaded, program):
    assert loaded.ask(Play(program, False)) is Result.NO_PROGRAM


def test_a_stop_ends_a_program_at_once(loaded):
    loaded.ask(Play(Program.TABLE, True))
    loaded.run(2.5)
    loaded.ask(Stop())
    _, counts = loaded.record(1.0)
    assert len(set(map(tuple, counts[1:].tolist()))) == 1
    assert loaded.state().mode is Mode.STOPPED


def test_setpoints_are_refused_while_it_plays_and_arm_takes_over(loaded):
    loaded.ask(Play(Program.TABLE, True))
    loaded.run(2.5)
    loaded.send(Setpoint(200, PARK))
    (fault,) = loaded.faults()
    assert (fault.code, fault.value) == (FaultCode.NOT_ARMED, Mode.PLAYING)
    assert loaded.ask(TableBegin(2, 50)) is Result.NO_PROGRAM
    assert loaded.ask(Arm(PARK)) is Result.OK
    assert loaded.state().mode is Mode.ARMED
    _, counts = loaded.record(0.5)
    assert len(set(map(tuple, counts.tolist()))) == 1
