"""The fake board in real time: its brain, its servos and its line, in one thread."""

import select
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from bridge.calibration import COUNTS_PER_US, Calibration
from bridge.fake.board import AnyBoard, Board, MakeBoard
from bridge.fake.board_faults import BoardFaults
from bridge.fake.board_settings import BoardSettings
from bridge.fake.fake_line import FakeLine
from bridge.fake.faults import Faults
from bridge.fake.program import CrankHexapod
from bridge.fake.servo import Plant, Servos, Steppers
from bridge.protocol import ResetCause
from bridge.servo_config import BoardConfig
from manipulator.arrays import Array

LONGEST_STEP, POSITIONS_PERIOD = 0.05, 0.02
"""Seconds; where this process stalls for longer, the board's time stands still meanwhile."""

DRIVES: dict[str, type[Servos]] = {'servos': Servos, 'steppers': Steppers}


class BoardMachine(Protocol):
    """What the thread steps: a FakeMachine, or what watches one."""

    @property
    def board(self) -> AnyBoard:
        """Its brain."""

    @property
    def servos(self) -> Plant:
        """Where its joints truly are."""

    def step(self, dt: float, stuck_channel: int | None = None) -> None:
        """Lets time pass, in s."""


@dataclass(frozen=True)
class FakeMachine:
    """Board and servos of one machine, before they are put on a line.

    is_measured: the board has encoders and reports what they read.
    """

    board: AnyBoard
    servos: Plant
    calibration: Calibration
    is_measured: bool = False

    @classmethod
    def from_config(
        cls,
        config: BoardConfig,
        boot_s: float,
        hysteresis: float,
        hexapod: CrankHexapod | None = None,
        make_board: MakeBoard = Board,
    ) -> 'FakeMachine':
        """Unpowered at park; hysteresis in rad (or m); `hexapod` is what cycles are played by."""
        calibration = Calibration.from_config(config.servos)
        dead_band = COUNTS_PER_US * config.simulation.dead_band_us / np.abs(calibration.scale)
        drives = DRIVES[config.simulation.drives]
        servos = drives.at_rest(calibration.park, calibration.speed, dead_band, hysteresis)
        settings = BoardSettings.from_config(config, boot_s, hexapod)
        board = make_board(settings, round(1000 * config.simulation.battery_v))
        return cls(board, servos, calibration, config.simulation.joints == 'measured')

    def step(self, dt: float, stuck_channel: int | None = None) -> None:
        """Board first, then the servos that it drives, but for one that is stuck."""
        self.board.step(dt)
        pulses = [np.nan if pulse is None else pulse for pulse in self.board.pulses]
        if stuck_channel is not None:
            pulses[stuck_channel] = np.nan
        self.servos.step(self.calibration.positions(pulses), dt)
        if self.is_measured:
            self.board.measure(self.calibration.nearest_counts(self.servos.positions))


class BoardThread(threading.Thread):
    """Steps the machine when bytes arrive, and when its board begins a period of pulses.

    Board and line are touched in this thread alone; `do` hands a request into it. on_positions
    receives the true joint positions 50 times a second, in this thread.
    """

    def __init__(
        self,
        machine: BoardMachine,
        line: FakeLine,
        on_positions: Callable[[Array], None],
        faults: Faults | None = None,
    ) -> None:
        """`faults` is what goes wrong; nothing, where there are none."""
        super().__init__(name='board', daemon=True)
        self.is_mute = False
        self._faults = BoardFaults(machine.board, faults or Faults(), self._replug)
        self._make_line = line.another
        self._machine = machine
        self._line: FakeLine | None = line
        self._on_positions = on_positions
        self._requests: deque[Callable[[], None]] = deque()
        self._is_stopping = False

    def do(self, request: Callable[[], None]) -> None:
        """Has it done before the next step."""
        self._requests.append(request)

    def plug(self, line: FakeLine | None) -> None:
        """Pulls the plug, and puts it into another line if there is one; a request."""
        if self._line is not None:
            self._line.close()
        self._line = line
        if line is not None:
            self._machine.board.reset(ResetCause.POWER_ON)

    def close(self) -> None:
        """Ends the thread and removes the port."""
        self._is_stopping = True
        if self.is_alive():
            self.join()
        self.plug(None)

    def run(self) -> None:
        """The thread's work, until `close`."""
        last = due = time.monotonic()
        while not self._is_stopping:
            has_input = self._wait(last + min(self._machine.board.rest, POSITIONS_PERIOD))
            while self._requests:
                self._requests.popleft()()
            now = time.monotonic()
            self._faults.advance(now)
            self._machine.step(min(now - last, LONGEST_STEP), self._faults.stuck_channel)
            last = now
            self._exchange(has_input, now)
            if now >= due:
                due = max(due + POSITIONS_PERIOD, now)  # what was missed is not made up for
                self._on_positions(self._machine.servos.positions)

    def _wait(self, until: float) -> bool:
        """Whether the line has something to read."""
        lines = [] if self._line is None else [self._line]
        timeout = max(until - time.monotonic(), 0.0)
        return bool(select.select(lines, [], [], timeout)[0])

    def _replug(self, is_in: bool) -> None:
        self.plug(self._make_line() if is_in else None)

    def _exchange(self, has_input: bool, now: float) -> None:
        board = self._machine.board
        output = board.take_output()
        if self._line is None:
            return
        received = self._line.read() if has_input else b''
        board.feed(self._faults.to_board(received, now))
        output = self._faults.to_host(output + board.take_output(), now)
        if output and not self.is_mute:
            self._line.write(output)
