"""The board with its servos, and the cable to it; every frame and every pulse is kept."""

import numpy as np

from bridge.fake.board_thread import LONGEST_STEP
from bridge.framing import FrameReader
from bridge.protocol import ResetCause
from world.timeline import Line, Process

STEP = 0.01
"""Seconds; the pulses are looked at so often, twice a period."""


class Cable:
    """Bytes both ways; `frames` are (time, message) of what the host put on it."""

    def __init__(self, timeline, board):
        self.is_plugged = True
        self.frames = []
        self._board = board
        self._reader = FrameReader()
        self._down = Line(board, board.on_bytes)
        self._up = None
        self._bridge = None

    def lead_to(self, bridge):
        self._bridge = bridge
        self._up = Line(bridge, bridge.on_bytes)

    @property
    def links(self):
        return self._down, self._up

    def send_to_board(self, output):
        if output and self.is_plugged:
            now = self._board.now
            self.frames += [(now, frame.message) for frame in self._reader.feed(output)]
            self._down.send(output)

    def send_to_host(self, output):
        if output and self.is_plugged:
            self._up.send(output)

    def pull(self):
        self.is_plugged = False
        self._bridge.handle(self._bridge.on_unplugged)

    def plug(self):
        """The board gets its power from it: it starts again."""
        self.is_plugged = True
        self._board.machine.board.reset(ResetCause.POWER_ON)


class BoardProcess(Process):
    """Steps a FakeMachine at 100 Hz and whenever bytes arrive.

    pulses: (time, counts by channel, NaN where none goes out) after each step.
    """

    def __init__(self, timeline, machine):
        super().__init__(timeline)
        self.machine = machine
        self.stuck_channel = None
        self.pulses = []
        self.true_joints = []
        self.cable = None
        self._stepped_at = self.now
        self.every(STEP, self._step)

    def on_bytes(self, received):
        self._pass_time()
        self.machine.board.feed(received)
        self._speak()

    def _step(self):
        self._pass_time()
        counts = np.array([np.nan if p is None else p for p in self.machine.board.pulses])
        self.pulses.append((self.now, counts))
        self.true_joints.append((self.now, self.machine.servos.positions.copy()))
        self._speak()

    def _pass_time(self):
        self.machine.step(min(self.now - self._stepped_at, LONGEST_STEP), self.stuck_channel)
        self._stepped_at = self.now

    def _speak(self):
        self.cable.send_to_host(self.machine.board.take_output())
