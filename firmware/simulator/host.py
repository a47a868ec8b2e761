"""A host that talks to the simulated board, and looks at its servo pins."""

import numpy as np
from numpy.typing import NDArray

from bridge.fake.board_settings import BoardSettings
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.protocol import Ack, Arm, Command, Message, Result, Setpoint, State
from firmware.simulator.board import SimulatedBoard
from firmware.simulator.chip import CLOCK_HZ, CYCLES_A_COUNT

JOINTS = 6
PARK = (3000, 2900, 3100, 3000, 2900, 3100)
SETTINGS = BoardSettings(
    count_ranges=((1100, 4900),) * JOINTS,
    count_speeds=(12_600.0,) * JOINTS,
    arm_interval_us=20_000,
    minimum_battery_mv=6400,
    boot_us=0,
)
PERIOD = CLOCK_HZ // 50

Cycles = NDArray[np.int64]


class Host:
    """Talks to one board of six joints; times in seconds."""

    def __init__(self, settings: BoardSettings = SETTINGS) -> None:
        self.board = SimulatedBoard(settings)
        self.chip = self.board.chip
        self.reader = FrameReader()
        self.sequence = 0
        self.last_state: State | None = None
        self._risen = 0

    def run(self, dt: float) -> list[Message]:
        """Messages that came meanwhile."""
        self.board.step(dt)
        messages = [frame.message for frame in self.reader.feed(self.board.take_output())]
        for message in messages:
            if isinstance(message, State):
                self.last_state = message
        return messages

    def run_to_phase(self, count: int) -> None:
        """Until the pulses' timers stand at `count` half microseconds of their period."""
        since = (self.chip.cycle - self._risen) % PERIOD
        self.run((CYCLES_A_COUNT * count - since) % PERIOD / CLOCK_HZ)

    def send(self, message: Setpoint | Command) -> int:
        """Under the next sequence number, which is the result."""
        self.sequence = (self.sequence + 1) & 0xFFFF
        self.board.feed(encode(message, self.sequence))
        return self.sequence

    def ask(self, message: Command) -> Result:
        """The board's answer."""
        sequence = self.send(message)
        answers = [m for m in self.run(0.04) if isinstance(m, Ack) and m.sequence == sequence]
        return answers[0].result

    def arm(self) -> None:
        """From power-up until all servos stand at PARK."""
        self.run(0.1)
        self.ask(Arm(PARK))
        self.run(0.3)
        self.pulses()
        self.run(0.1)
        self.pulses()

    def state(self) -> State:
        """A fresh one."""
        self.last_state = None
        self.run(0.04)
        assert self.last_state is not None, 'no STATE in 40 ms'
        return self.last_state

    def pulses(self) -> tuple[Cycles, Cycles]:
        """Rising edges and widths (n, 6) in cycles since the last call, of whole periods."""
        edges = self.chip.edges()
        rises, widths = [], []
        for channel in range(JOINTS):
            mine = edges[edges['channel'] == channel]
            mine = mine[np.argmax(mine['level'] == 1) :] if len(mine) else mine
            mine = mine[: len(mine) // 2 * 2]
            assert np.array_equal(mine['level'], [1, 0] * (len(mine) // 2))
            cycles = mine['cycle'].astype(np.int64).reshape(-1, 2)
            rises.append(cycles[:, 0])
            widths.append(np.diff(cycles, axis=1)[:, 0])
        whole = min(map(len, widths))
        if whole:
            self._risen = int(rises[0][whole - 1])
        return np.array([r[:whole] for r in rises]).T, np.array([w[:whole] for w in widths]).T

    def pulse_counts(self) -> list[tuple[int, ...]]:
        """The same widths in counts; the simulation is exact to a few cycles."""
        _, widths = self.pulses()
        return [tuple(row) for row in np.rint(widths / CYCLES_A_COUNT).astype(int).tolist()]
