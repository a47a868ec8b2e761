"""The program on this computer and on the chip puts out the same pulses for the same frames."""

import dataclasses
import math
import random

import numpy as np
import pytest

from bridge.fake.board import Board
from bridge.frames import encode, table_crc
from bridge.protocol import (
    Arm,
    Clear,
    CycleAxis,
    Disarm,
    Finish,
    Play,
    Program,
    Setpoint,
    Stop,
    TableBegin,
    TableEnd,
    TableRow,
)
from firmware.simulator.board import SimulatedBoard
from hexarm.board.header import settings_of

PARK = (3000,) * 6
PERIOD = 0.02
HALFWAY = 0.5 * PERIOD
SETTINGS = dataclasses.replace(settings_of('robocake'), arm_interval_us=40_000)
DEADLINES_MS = (55, 95, 255)
"""They pass in the middle of a period on both: the chip takes 3 ms to start, and a frame 1 ms."""
ROWS = [tuple(round(3000 + 90 * math.sin(0.3 * k + i)) for i in range(6)) for k in range(21)]


def trace(make, script, seed, settings=SETTINGS):
    """Counts (periods, joints), NaN where there is no pulse; a message goes out between two.

    script: for each period what is sent in the middle of it, from a generator of random numbers.
    """
    board, sequence, rows = make(settings), 0, []
    board.step(HALFWAY)
    for messages in script(random.Random(seed)):
        for message in messages:
            sequence += 1
            board.feed(encode(message, sequence))
        board.step(PERIOD)
        board.take_output()
        rows.append(board.pulses)
    return np.array(rows, dtype=float)


def arming():
    yield [Arm(PARK)]
    yield from [[]] * 20


def driven(rng):
    """Setpoints near and far, deadlines that pass, stops, releases."""
    yield from arming()
    target = list(PARK)
    for _ in range(600):
        chance = rng.random()
        if chance < 0.7:
            reach = rng.choice([3, 60, 1900])
            target = [min(max(t + rng.randint(-reach, reach), 1100), 4900) for t in target]
            yield [Setpoint(rng.choice(DEADLINES_MS), tuple(target))]
        elif chance < 0.75:
            yield [Stop()]
            yield [Clear()]
        elif chance < 0.77:
            yield [Disarm()]
            yield from arming()
        else:
            yield from [[]] * rng.randrange(1, 9)


def played(rng):
    """A cycle and a table, in loops and once, ended by a command and by themselves."""
    yield from arming()
    yield [CycleAxis(2, 0.004, 500, 0.3), CycleAxis(5, 0.05, 1500, -1.0)]
    yield [Play(Program.CYCLE, True)]
    yield from [[]] * 400
    yield [Finish()]
    yield from [[]] * 70
    yield [TableBegin(len(ROWS), 100)]
    for index, row in enumerate(ROWS):
        yield [TableRow(index, row)]
    yield [TableEnd(table_crc(ROWS))]
    yield [Play(Program.TABLE, rng.random() < 0.5)]
    yield from [[]] * 250
    yield [Stop()]
    yield from [[]] * 5


@pytest.mark.parametrize('script', [driven, played])
@pytest.mark.parametrize('seed', range(3))
def test_computer_and_chip_make_the_same_pulses_to_one_count(chip_tools, script, seed):
    ours, chips = (trace(make, script, seed) for make in (Board, SimulatedBoard))
    np.testing.assert_array_equal(np.isnan(ours), np.isnan(chips))
    assert np.nanmax(np.abs(ours - chips)) <= 1
    assert np.nanmax(np.abs(np.diff(ours, axis=0))) > 50


def test_a_release_on_link_loss_comes_in_the_same_period(chip_tools):
    def silent(rng):
        yield from arming()
        yield [Setpoint(DEADLINES_MS[0], PARK)]
        yield from [[]] * 10

    settings = dataclasses.replace(SETTINGS, on_link_loss='release')
    ours, chips = (trace(make, silent, 0, settings) for make in (Board, SimulatedBoard))
    np.testing.assert_array_equal(np.isnan(ours), np.isnan(chips))
    assert np.isnan(ours[-1]).all()
