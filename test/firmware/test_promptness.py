"""No command keeps the board from its stop button and its deadlines, however long its table."""

import dataclasses
import math

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.frames import table_crc
from bridge.protocol import Ack, Arm, Mode, Play, Program, Result, TableBegin, TableEnd, TableRow
from bridge.servo_config import BoardConfig
from firmware.simulator.host import PARK, SETTINGS, Host
from hexarm import machines
from hexarm.board.table import read_table

CALIBRATION = Calibration.from_config(BoardConfig.from_machine(machines.read('robocake')).servos)
LONGEST_FRAME = 0.0025
"""Seconds that a frame and its answer take on the line, a STATE ahead of it included."""


def answer_time(host, command):
    """Seconds from the command to its ACK, which must be OK."""
    host.run(0.05)
    sequence, start = host.send(command), host.chip.seconds
    while True:
        for message in host.run(0.0005):
            if isinstance(message, Ack) and message.sequence == sequence:
                assert message.result is Result.OK
                return host.chip.seconds - start
        assert host.chip.seconds < start + 0.5, 'no answer'


def test_the_longest_table_is_taken_and_played_within_milliseconds(armed):
    rows = [tuple(c + k % 40 for c in PARK) for k in range(448)]
    times = [answer_time(armed, TableBegin(len(rows), 50))]
    for index, row in enumerate(rows):
        armed.send(TableRow(index, row))
        armed.run(0.003)
    times.append(answer_time(armed, TableEnd(table_crc(rows))))
    times.append(answer_time(armed, Arm(PARK)))
    times.append(answer_time(armed, Play(Program.TABLE, True)))
    assert max(times) < LONGEST_FRAME + 0.005
    armed.run(1.0)
    assert armed.state().mode is Mode.PLAYING


@pytest.fixture(scope='module')
def longest_csv(tmp_path_factory):
    """As many rows as flash holds: all cranks swing by 5° about 120°, once in two seconds."""
    names = ','.join(['time', *CALIBRATION.names])
    rows = [(0.05 * k, math.radians(120 + 5 * math.sin(0.05 * math.pi * k))) for k in range(2730)]
    lines = [','.join([f'{t:.3f}', *[f'{q:.6f}'] * 6]) for t, q in rows]
    path = tmp_path_factory.mktemp('table') / 'longest.csv'
    path.write_text('\n'.join([names, *lines]) + '\n')
    return path


def test_the_longest_table_in_flash_is_played_within_milliseconds(longest_csv):
    host = Host(dataclasses.replace(SETTINGS, table=read_table(longest_csv, CALIBRATION)))
    host.run(0.1)
    host.ask(Arm(CALIBRATION.counts(np.radians([120.0] * 6))))
    host.run(0.3)
    assert answer_time(host, Play(Program.FLASH_TABLE, True)) < LONGEST_FRAME + 0.005
    host.run(1.0)
    assert host.state().mode is Mode.PLAYING
    assert host.chip.watchdog_resets == 0
