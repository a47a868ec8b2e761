"""A session and a board in one time, and a line between them that can fail."""

import pytest

from bridge.events import StateReceived
from bridge.fake.board import Board
from bridge.fake.board_settings import BoardSettings
from bridge.framing import FrameReader
from bridge.protocol import Arm, Setpoint
from bridge.session import Session

PARK = (3000,) * 6
SETTINGS = BoardSettings(((1100, 4900),) * 6, (12_600.0,) * 6, boot_us=300_000)


class Line:
    """A session and a board in one time; `loses` drops frames of the host."""

    def __init__(self, joint_count=6, **settings):
        self.board = Board(BoardSettings(**{**SETTINGS.__dict__, **settings}))
        self.session = Session(joint_count)
        self.now = 100.0
        self.session.opened(self.now)
        self.sent = []
        self.loses = False
        self.is_mute = False

    def run(self, seconds):
        """Events other than STATE."""
        events = []
        for _ in range(round(seconds / 0.005)):
            self.now += 0.005
            self.board.step(0.005)
            received = b'' if self.is_mute else self.board.take_output()
            events += self.session.receive(received, self.now) + self.session.tick(self.now)
            output = self.session.take_output()
            self.sent += [frame.message for frame in FrameReader().feed(output)]
            if not self.loses:
                self.board.feed(output)
        return [event for event in events if not isinstance(event, StateReceived)]

    def command(self, command):
        return self.session.send_command(command, self.now) + self.run(0.05)

    def setpoint(self, counts=PARK):
        self.session.send_setpoint(Setpoint(200, counts), self.now)

    def arm(self):
        self.run(0.4)
        events = self.command(Arm(PARK))
        self.run(1.0)
        return events


@pytest.fixture
def line_of():
    """Makes a line to another board, or of a session that expects one."""
    return Line


@pytest.fixture
def line():
    """A line whose board has just got its power."""
    return Line()


@pytest.fixture
def armed(line):
    """The same, with the board armed: it takes setpoints."""
    line.arm()
    return line
