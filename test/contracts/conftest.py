"""Boards that must all pass the same tests, behind `feed(bytes)`, `step(dt)`, `take_output()`."""

import dataclasses

import numpy as np
import pytest

from bridge.fake.board import Board
from bridge.fake.board_settings import BoardSettings
from bridge.frames import encode, table_crc
from bridge.framing import FrameReader
from bridge.protocol import (
    Ack,
    Arm,
    Fault,
    Hello,
    ResetCause,
    Result,
    State,
    TableBegin,
    TableEnd,
    TableRow,
)
from firmware.simulator.board import SimulatedBoard
from hexarm.board.header import settings_of

RANGE = (1100, 4900)
JOINTS = 6
PARK = (3000, 2900, 3100, 3000, 2900, 3100)
SETTINGS = BoardSettings(
    count_ranges=(RANGE,) * JOINTS,
    count_speeds=(12_600.0,) * JOINTS,
    arm_interval_us=150_000,
    minimum_battery_mv=6400,
    boot_us=300_000,
    hexapod=settings_of('robocake').hexapod,
)


class BoardHost:
    """Plays the host to one board; time passes in steps of 5 ms."""

    def __init__(self, make_board, **changes):
        self.board = make_board(dataclasses.replace(SETTINGS, **changes))
        self.reader = FrameReader()
        self.sequence = 0

    def run(self, seconds):
        """Messages that the board sent meanwhile, at least until all we said is on the line."""
        messages = []
        steps = round(seconds / 0.005)
        while steps > 0 or getattr(self.board, 'backlog', 0):
            self.board.step(0.005)
            messages += [frame.message for frame in self.reader.feed(self.board.take_output())]
            steps -= 1
        return messages

    def send(self, message, sequence=None):
        """Under the next sequence number, or a given one."""
        if sequence is None:
            sequence = self.sequence = (self.sequence + 1) & 0xFFFF
        self.board.feed(encode(message, sequence))
        return sequence

    def ask(self, message, sequence=None):
        """The result of a command."""
        sequence = self.send(message, sequence)
        (ack,) = [m for m in self.run(0.04) if isinstance(m, Ack)]
        assert ack.sequence == sequence
        return ack.result

    def arm(self, park=PARK):
        self.run(0.4)
        result = self.ask(Arm(park))
        self.run(1.0)
        return result

    def upload(self, rows, step_ms=50):
        """The result of a table's end."""
        assert self.ask(TableBegin(len(rows), step_ms)) is Result.OK
        for index, row in enumerate(rows):
            assert self.ask(TableRow(index, row)) is Result.OK
        return self.ask(TableEnd(table_crc(rows)))

    def press_start(self):
        """The start button, for a tenth of a second; what the board said meanwhile."""
        self.board.is_start_closed = True
        messages = self.run(0.1)
        self.board.is_start_closed = False
        return messages + self.run(0.1)

    def state(self):
        return [m for m in self.run(0.04) if isinstance(m, State)][-1]

    def counts(self):
        return tuple(joint.count for joint in self.state().joints)

    def record(self, seconds):
        """Modes and counts (n, joints), 50 times a second."""
        states = [m for m in self.run(seconds) if isinstance(m, State)]
        counts = [[joint.count for joint in state.joints] for state in states]
        return [state.mode for state in states], np.array(counts)

    def faults(self):
        return [m for m in self.run(0.04) if isinstance(m, Fault)]

    def hellos(self, seconds):
        return [m for m in self.run(seconds) if isinstance(m, Hello)]

    def reset(self, cause=ResetCause.WATCHDOG):
        self.board.reset(cause)


BOARDS = {'computer': Board, 'chip': SimulatedBoard}


@pytest.fixture
def make_both(chip_tools):
    """A BoardHost of each board, for settings that differ from the usual ones."""
    return lambda **changes: [BoardHost(board, **changes) for board in BOARDS.values()]


@pytest.fixture(params=['computer', pytest.param('chip', marks=pytest.mark.long)])
def make_driver(request):
    """A BoardHost for settings that differ from the usual ones."""
    if request.param == 'chip':
        request.getfixturevalue('chip_tools')
    return lambda **changes: BoardHost(BOARDS[request.param], **changes)


@pytest.fixture
def driver(make_driver):
    """A board that has just been switched on."""
    return make_driver()


@pytest.fixture
def armed(driver):
    """A board whose servos are all on, at PARK."""
    driver.arm()
    return driver
