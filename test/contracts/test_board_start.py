"""Unplugged: the start button arms and plays what is there, and ends it; the stop button stops."""

import math

import numpy as np
import pytest

from bridge.programs import CountTable
from bridge.protocol import Arm, CycleAxis, Mode, Play, Program, Result, Setpoint, State

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
WAVE = [tuple(round(c + 100 * math.sin(math.pi * k / 10)) for c in PARK) for k in range(20)]
FLASHED = CountTable(tuple(WAVE), 100)
RAMP = CountTable(tuple((3000 + 500 * k,) * 6 for k in range(4)), 50)


def modes(driver, seconds):
    return [m.mode for m in driver.run(seconds) if isinstance(m, State)]


@pytest.fixture
def flashed(make_driver):
    """A board with a table in flash, just switched on."""
    driver = make_driver(table=FLASHED, arm_interval_us=20_000)
    driver.run(0.4)
    return driver


def test_it_arms_where_the_uploaded_table_begins_plays_it_and_ends_it(make_driver):
    driver = make_driver(arm_interval_us=20_000)
    driver.run(0.4)
    rows = [tuple(count + 50 for count in row) for row in WAVE]
    assert driver.upload(rows, 100) is Result.OK
    driver.press_start()
    assert driver.board.pulses[0] == rows[0][0]
    driver.run(8.0)
    seen, counts = driver.record(4.0)
    assert set(seen) == {Mode.PLAYING}
    assert counts[:, 0].max() == pytest.approx(3150, abs=3)
    assert counts[:, 0].min() == pytest.approx(2950, abs=3)
    driver.press_start()
    assert modes(driver, 2.0)[-1] is Mode.ARMED


def test_a_table_in_flash_is_played_after_power_up(flashed):
    assert flashed.board.pulses == (None,) * 6
    flashed.press_start()
    assert modes(flashed, 6.0)[-1] is Mode.PLAYING
    _, counts = flashed.record(3.0)
    assert counts.max(axis=0) == pytest.approx(np.array(PARK) + 100, abs=3)
    assert counts.min(axis=0) == pytest.approx(np.array(PARK) - 100, abs=3)
    assert np.abs(np.diff(counts, axis=0)).max() <= 12
    flashed.board.is_stop_open = True
    flashed.run(0.1)
    flashed.board.is_stop_open = False
    flashed.run(0.1)
    assert flashed.state().mode is Mode.STOPPED
    there = flashed.board.pulses
    flashed.press_start()
    assert (flashed.state().mode, flashed.board.pulses) == (Mode.ARMED, there)


def test_a_host_plays_the_table_in_flash_as_well(flashed):
    flashed.ask(Arm(PARK))
    flashed.run(0.3)
    assert flashed.ask(Play(Program.FLASH_TABLE, False)) is Result.OK
    flashed.run(8.0)
    assert flashed.board.pulses == pytest.approx(WAVE[-1], abs=1)


def test_a_table_in_flash_whose_end_is_far_from_its_start_is_not_played_in_a_loop(make_driver):
    driver = make_driver(table=RAMP)
    driver.arm(RAMP.rows[0])
    assert driver.ask(Play(Program.FLASH_TABLE, True)) is Result.TOO_FAST
    assert driver.ask(Play(Program.FLASH_TABLE, False)) is Result.OK


def test_a_cycle_that_was_set_is_played(make_driver):
    driver = make_driver(arm_interval_us=20_000)
    driver.run(0.4)
    driver.ask(CycleAxis(2, 0.002, 1000, 0.0))
    driver.press_start()
    seen = modes(driver, 6.0)
    assert Mode.CHECKING in seen
    assert seen[-1] is Mode.PLAYING


def test_without_a_program_it_does_nothing(driver):
    driver.run(0.4)
    driver.press_start()
    assert driver.state().mode is Mode.DISARMED
    assert driver.board.pulses == (None,) * 6


def test_with_the_stop_contact_open_it_does_nothing(flashed):
    flashed.board.is_stop_open = True
    flashed.run(0.1)
    flashed.press_start()
    flashed.run(1.0)
    assert flashed.state().mode is Mode.STOPPED
    assert flashed.board.pulses == (None,) * 6


def test_a_host_that_arms_takes_over(flashed):
    flashed.press_start()
    flashed.run(3.0)
    assert flashed.ask(Arm((3000,) * 6)) is Result.OK
    assert flashed.state().mode is Mode.ARMED
    assert set(modes(flashed, 1.0)) == {Mode.ARMED}


def test_a_machine_that_a_host_drives_is_the_hosts(flashed):
    flashed.ask(Arm(PARK))
    flashed.run(0.3)
    for _ in range(10):
        flashed.send(Setpoint(200, PARK))
        flashed.run(0.05)
        flashed.board.is_start_closed = True
        flashed.run(0.05)
        flashed.board.is_start_closed = False
    assert flashed.state().mode is Mode.ARMED
    flashed.run(0.3)
    assert flashed.state().mode is Mode.HOLDING
    flashed.press_start()
    assert modes(flashed, 0.5)[-1] is Mode.PLAYING
