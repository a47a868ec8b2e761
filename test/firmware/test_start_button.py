"""Unplugged: the start button arms and plays what is there, and ends it; the stop button stops."""

import dataclasses
import math

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.frames import table_crc
from bridge.programs import CountTable
from bridge.protocol import (
    Arm,
    CycleAxis,
    Mode,
    Result,
    Setpoint,
    State,
    TableBegin,
    TableEnd,
    TableRow,
)
from bridge.servo_config import BoardConfig
from firmware.simulator.host import SETTINGS, Host
from hexarm import machines
from hexarm.board.header import settings_of
from hexarm.board.table import flash_header, read_table
from hexarm.cli.main import main
from manipulator.errors import ConfigError

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
WAVE = [tuple(round(c + 100 * math.sin(math.pi * k / 10)) for c in PARK) for k in range(20)]
CONFIG = BoardConfig.from_machine(machines.read('robocake'))
CALIBRATION = Calibration.from_config(CONFIG.servos)


def press(host):
    """The start button."""
    host.board.is_start_closed = True
    host.run(0.1)
    host.board.is_start_closed = False
    host.run(0.1)


def modes(host, seconds):
    return [m.mode for m in host.run(seconds) if isinstance(m, State)]


@pytest.fixture
def csv_file(tmp_path):
    """A table of two seconds: all cranks swing by 5° about 120°, in a loop."""
    names = ','.join(['time', *CALIBRATION.names])
    rows = [(0.1 * k, math.radians(120 + 5 * math.sin(0.1 * math.pi * k))) for k in range(20)]
    lines = [','.join([f'{t:.3f}', *[f'{q:.6f}'] * 6]) for t, q in rows]
    path = tmp_path / 'swing.csv'
    path.write_text('\n'.join([names, *lines]) + '\n')
    return path


def test_it_arms_where_the_uploaded_table_begins_plays_it_and_ends_it(host):
    host.run(0.1)
    rows = [tuple(count + 50 for count in row) for row in WAVE]
    host.ask(TableBegin(len(rows), 100))
    for index, row in enumerate(rows):
        host.ask(TableRow(index, row))
    assert host.ask(TableEnd(table_crc(rows))) is Result.OK
    press(host)
    assert host.board.pulses[0] == rows[0][0]
    seen = modes(host, 10.0)
    assert seen[-1] is Mode.PLAYING
    _, widths = host.pulses()
    counts = np.rint(widths[-200:] / 8)
    assert counts[:, 0].max() == pytest.approx(3150, abs=3)
    assert counts[:, 0].min() == pytest.approx(2950, abs=3)
    press(host)
    assert modes(host, 2.0)[-1] is Mode.ARMED


def test_a_table_in_flash_is_played_after_power_up(csv_file):
    host = Host(table=csv_file)
    host.run(0.5)
    assert len(host.chip.edges()) == 0
    press(host)
    assert modes(host, 6.0)[-1] is Mode.PLAYING
    counts = np.array(host.pulse_counts()[-150:])
    low, high = (CALIBRATION.counts(np.radians([120 + s] * 6)) for s in (-5, 5))
    assert counts[:, 0].min() == pytest.approx(min(low[0], high[0]), abs=3)
    assert counts[:, 0].max() == pytest.approx(max(low[0], high[0]), abs=3)
    assert np.abs(np.diff(counts, axis=0)).max() <= 12
    host.board.is_stop_open = True
    host.run(0.1)
    host.board.is_stop_open = False
    host.run(0.1)
    assert host.state().mode is Mode.STOPPED
    there = host.board.pulses
    press(host)
    assert (host.state().mode, host.board.pulses) == (Mode.ARMED, there)


def test_a_cycle_that_was_set_is_played(tools):
    host = Host(dataclasses.replace(SETTINGS, hexapod=settings_of('robocake').hexapod))
    host.run(0.1)
    host.ask(CycleAxis(2, 0.002, 1000, 0.0))
    press(host)
    seen = modes(host, 6.0)
    assert Mode.CHECKING in seen
    assert seen[-1] is Mode.PLAYING


def test_without_a_program_it_does_nothing(host):
    press(host)
    assert host.state().mode is Mode.DISARMED
    assert len(host.chip.edges()) == 0


def test_with_the_stop_contact_open_it_does_nothing(csv_file):
    host = Host(table=csv_file)
    host.board.is_stop_open = True
    host.run(0.1)
    press(host)
    host.run(1.0)
    assert host.state().mode is Mode.STOPPED
    assert len(host.chip.edges()) == 0


def test_a_host_that_arms_takes_over(csv_file):
    host = Host(table=csv_file)
    host.run(0.1)
    press(host)
    host.run(3.0)
    assert host.ask(Arm((3000,) * 6)) is Result.OK
    assert host.state().mode is Mode.ARMED
    assert set(modes(host, 1.0)) == {Mode.ARMED}


def test_a_machine_that_a_host_drives_is_the_hosts(csv_file):
    host = Host(table=csv_file)
    host.run(0.1)
    start = CALIBRATION.counts(np.radians([120.0] * 6))
    host.ask(Arm(start))
    host.run(0.3)
    for _ in range(10):
        host.say(Setpoint(200, start))
        host.run(0.05)
        host.board.is_start_closed = True
        host.run(0.05)
        host.board.is_start_closed = False
    assert host.state().mode is Mode.ARMED
    host.run(0.3)
    assert host.state().mode is Mode.HOLDING
    press(host)
    assert modes(host, 0.5)[-1] is Mode.PLAYING


def test_the_header_of_a_table_holds_the_counts_of_its_positions(csv_file, capsys):
    assert main(['firmware-header', 'robocake', '--table', str(csv_file)]) == 0
    printed = capsys.readouterr().out
    table = read_table(csv_file, CALIBRATION)
    assert printed == flash_header(table, 'swing.csv', CALIBRATION)
    assert (len(table.rows), table.step_ms) == (20, 100)
    assert table.rows[5] == CALIBRATION.counts(np.radians([125.0] * 6))
    assert '#define FLASH_TABLE_ROWS 20' in printed
    assert '#define FLASH_TABLE_LOOPS 1' in printed


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        (('0.100,', '0.130,'), 'time steps'),
        (('2.094395', '9.9'), 'row 0: crank_1: 9.9 rad outside'),
        (('crank_2', 'elbow'), 'needs time, crank_1'),
        (('2.094395', 'nan'), 'not finite'),
        (('2.094395', 'two'), 'cannot be read'),
        (('0.100,2.1', '0.100,0.9'), 'row 0 to 1: crank_1 would have to be'),
    ],
)
def test_a_table_that_is_none_is_refused_by_name(csv_file, capsys, change, words):
    csv_file.write_text(csv_file.read_text().replace(*change, 1))
    assert main(['firmware-header', 'robocake', '--table', str(csv_file)]) == 1
    assert words in capsys.readouterr().err


def test_a_table_that_cannot_be_played_in_a_loop_says_so():
    rows = [(3000 + 500 * k,) * 6 for k in range(4)]
    once = flash_header(CountTable(tuple(rows), 50), 'ramp.csv', CALIBRATION)
    assert '#define FLASH_TABLE_LOOPS 0' in once


def test_a_table_that_flash_cannot_hold_is_refused():
    table = CountTable(((3000,) * 6,) * 2731, 50)
    with pytest.raises(ConfigError, match='2731 rows take 32772 bytes of flash, at most 2730'):
        flash_header(table, 'long.csv', CALIBRATION)
