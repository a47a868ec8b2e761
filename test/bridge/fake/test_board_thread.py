"""When the fake board's thread wakes up, on a simulated clock."""

from types import SimpleNamespace

import pytest

from bridge.fake import board_thread
from bridge.fake.board_thread import BoardThread, FakeMachine
from bridge.framing import FrameReader
from bridge.protocol import Hello
from bridge.servo_config import BoardConfig
from hexarm import machines

BOOT, SECONDS = 0.3, 2.0


class Line:
    """Nobody's: keeps when each message of the board came."""

    def __init__(self):
        self.now, self.wakes = 100.0, 0
        self.messages = []
        self.another = self.close = lambda: None
        self._reader = FrameReader()

    def select(self, lines, writing, odd, timeout):
        self.now += timeout
        self.wakes += 1
        return [], [], []

    def write(self, output):
        self.messages += [(self.now, frame.message) for frame in self._reader.feed(output)]


@pytest.fixture
def line(monkeypatch):
    """What a board of `robocake` writes in SECONDS from when it was switched on."""
    made = Line()
    config = BoardConfig.from_machine(machines.read('robocake'))
    thread = BoardThread(FakeMachine.from_config(config, BOOT, 0.0), made, lambda positions: None)

    def monotonic():
        thread._is_stopping = made.now >= 100.0 + SECONDS
        return made.now

    monkeypatch.setattr(board_thread, 'time', SimpleNamespace(monotonic=monotonic))
    monkeypatch.setattr(board_thread, 'select', SimpleNamespace(select=made.select))
    thread.run()
    return made


def test_first_hello_comes_when_the_boot_is_over(line):
    at, message = line.messages[0]
    assert isinstance(message, Hello)
    assert at - 100.0 == pytest.approx(BOOT, abs=1e-3)


def test_thread_wakes_once_a_period_and_messages_are_not_late(line):
    assert line.wakes <= SECONDS / 0.02 + 10
    phases = [(at - 100.0 - BOOT + 1e-3) % 0.02 for at, _ in line.messages]
    assert max(phases) < 2e-3
