"""What outlives a reset: the cycle, whatever was being written when the power went."""

import functools

import numpy as np
import pytest

from bridge.fake.board import Board
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.protocol import Ack, Arm, CycleAxis, Mode, Play, Program, ResetCause, Result, Stop
from hexarm.board.header import settings_of

HOME = (3000,) * 6
OLD, NEW = CycleAxis(2, 0.002, 500, 0.0), CycleAxis(2, 0.004, 500, 0.0)
WRITING = 2.0
"""Seconds after which a cycle is written for certain."""


def lift(driver):
    """By how many counts the cycle that a board knows lifts the platform; 0: it knows none."""
    driver.arm(HOME)
    if driver.ask(Play(Program.CYCLE, True)) is not Result.OK:
        return 0
    driver.run(5.0)
    _, counts = driver.record(2.0)
    return int(np.ptp(counts[:, 0]))


def test_the_cycle_outlives_a_reset(make_driver):
    driver = make_driver(arm_interval_us=20_000)
    driver.run(0.4)
    assert driver.ask(OLD) is Result.OK
    driver.run(WRITING)
    lifted = lift(driver)
    assert lifted > 100
    driver.reset(ResetCause.WATCHDOG)
    assert lift(driver) == pytest.approx(lifted, abs=2)


@pytest.mark.parametrize('seconds', [0.0, 0.4, 1.0, 1.4])
def test_a_reset_while_a_cycle_is_written_leaves_the_old_one(make_driver, seconds):
    driver = make_driver(arm_interval_us=20_000)
    driver.run(0.4)
    driver.ask(OLD)
    driver.run(WRITING)
    driver.reset(ResetCause.WATCHDOG)
    old = lift(driver)
    assert old > 100
    driver.ask(Stop())
    driver.ask(NEW)
    driver.run(seconds)
    driver.reset(ResetCause.WATCHDOG)
    assert lift(driver) == pytest.approx(old, abs=2)


@functools.cache
def robocake():
    return settings_of('robocake')


def result_of(board, message, sequence):
    """The result of a command."""
    board.take_output()
    board.feed(encode(message, sequence))
    messages = [frame.message for frame in FrameReader().feed(board.take_output())]
    return next(m.result for m in messages if isinstance(m, Ack))


def first_pulse_of_cycle(memory):
    """Where the first servo stands a quarter of the period into the cycle in a memory."""
    board = Board(robocake(), memory=memory)
    board.step(0.01)
    result_of(board, Arm(HOME), 1)
    board.step(1.5)
    if result_of(board, Play(Program.CYCLE, True), 2) is not Result.OK:
        return None
    board.step(2.04 + 0.5 + 2.5)
    assert board.mode is Mode.PLAYING
    return board.pulses[0]


def test_at_every_byte_that_is_written_there_is_the_old_cycle_or_the_new_one():
    """Six axes, as a host sets them; twice, so that either copy in the memory is the older one."""
    board = Board(robocake())
    board.step(0.01)
    memories, sequence = [], 0
    for amplitude in (0.001, 0.002, 0.003):
        for axis in range(6):
            sequence += 1
            result_of(board, CycleAxis(axis, amplitude if axis == 2 else 0.0, 500, 0.0), sequence)
        kept = []
        for _ in range(80):
            kept.append(board.memory)
            board.step(0.02)
        memories.append(list(dict.fromkeys([*kept, board.memory])))
    first, *later = ([first_pulse_of_cycle(m) for m in found] for found in memories)
    assert first[0] is None
    assert first[-1] is not None
    last = first[-1]
    for places in later:
        assert len(places) > 5
        assert set(places[:-1]) == {last}
        assert places[-1] not in (None, last)
        last = places[-1]


@pytest.mark.parametrize('memory', [b'', bytes(160), bytes(range(160))])
def test_a_memory_that_holds_no_cycle_is_none(memory):
    assert first_pulse_of_cycle(memory) is None
