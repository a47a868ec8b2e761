"""A CSV of joint positions as the table that is loaded with the board's program."""

import math

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.programs import CountTable
from bridge.servo_config import BoardConfig
from hexarm import machines
from hexarm.board.table import flash_header, read_table
from hexarm.cli.main import main
from manipulator.errors import ConfigError

CONFIG = BoardConfig.from_machine(machines.read('robocake'))
CALIBRATION = Calibration.from_config(CONFIG.servos)


@pytest.fixture
def csv_file(tmp_path):
    """A table of two seconds: all cranks swing by 5° about 120°, in a loop."""
    names = ','.join(['time', *CALIBRATION.names])
    rows = [(0.1 * k, math.radians(120 + 5 * math.sin(0.1 * math.pi * k))) for k in range(20)]
    lines = [','.join([f'{t:.3f}', *[f'{q:.6f}'] * 6]) for t, q in rows]
    path = tmp_path / 'swing.csv'
    path.write_text('\n'.join([names, *lines]) + '\n')
    return path


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
    assert main(['firmware-header', 'robocake', '--table', str(csv_file)]) == 2
    assert words in capsys.readouterr().err


def test_a_table_that_cannot_be_played_in_a_loop_says_so():
    rows = [(3000 + 500 * k,) * 6 for k in range(4)]
    once = flash_header(CountTable(tuple(rows), 50), 'ramp.csv', CALIBRATION)
    assert '#define FLASH_TABLE_LOOPS 0' in once


def test_a_table_that_flash_cannot_hold_is_refused():
    table = CountTable(((3000,) * 6,) * 2731, 50)
    with pytest.raises(ConfigError, match='2731 rows take 32772 bytes of flash, at most 2730'):
        flash_header(table, 'long.csv', CALIBRATION)
