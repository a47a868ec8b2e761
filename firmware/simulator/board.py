"""The simulated chip behind the fake board's three methods: feed, step, take_output."""

import numpy as np

from bridge.fake.board_settings import BoardSettings
from bridge.protocol import ResetCause
from firmware.simulator.chip import CLOCK_HZ, CYCLES_A_COUNT, Chip
from hexarm.board import build as firmware_build
from hexarm.board.header import header
from hexarm.board.table import flash_text

OFF_AFTER = 21 * CLOCK_HZ // 1000
"""A channel without a pulse for so long is off: a period is 20 ms."""
STOP_BUTTON, START_BUTTON = 0, 1
DIVIDER = 2


class SimulatedBoard:
    """The firmware for these settings, on a chip, its boot loader's silence included.

    rest: seconds until it does something by itself; what a chip does is not known before.
    """

    rest = 0.01

    def __init__(self, settings: BoardSettings, battery_mv: int = 7600) -> None:
        self.settings = settings
        self._flash()
        self.battery_mv = battery_mv
        self.is_stop_open = self.is_start_closed = False
        self.reset(ResetCause.POWER_ON)

    @property
    def battery_mv(self) -> int:
        """What the battery has, ahead of the divider."""
        return self._battery_mv

    @battery_mv.setter
    def battery_mv(self, value: int) -> None:
        self._battery_mv = value
        self.chip.set_battery_pin(value // DIVIDER)

    @property
    def pulses(self) -> tuple[float | None, ...]:
        """The width in counts of each channel's last pulse; None where none goes out any more."""
        self._read_edges()
        now = self.chip.cycle
        pairs = zip(self._risen.tolist(), self._widths.tolist(), strict=True)
        return tuple(
            round(width / CYCLES_A_COUNT) if width and now - risen < OFF_AFTER else None
            for risen, width in pairs
        )

    @property
    def is_stop_open(self) -> bool:
        """The stop button's contact."""
        return self._is_stop_open

    @is_stop_open.setter
    def is_stop_open(self, is_open: bool) -> None:
        self._is_stop_open = is_open
        self.chip.set_button(STOP_BUTTON, is_open)

    @property
    def is_start_closed(self) -> bool:
        """The start button's contact."""
        return self._is_start_closed

    @is_start_closed.setter
    def is_start_closed(self, is_closed: bool) -> None:
        self._is_start_closed = is_closed
        self.chip.set_button(START_BUTTON, not is_closed)

    @property
    def backlog(self) -> int:
        """Bytes that are still to be sent to the chip."""
        return self.chip.backlog

    def reset(self, cause: ResetCause) -> None:
        """Starts again, after the boot loader's silence."""
        if self.settings is not self._flashed:
            self._flash()
        self._boot_left = self.settings.boot_us * CLOCK_HZ // 1_000_000
        self._widths = np.zeros(len(self.settings.count_ranges), np.int64)
        self._risen = self._widths.copy()
        self.chip.reset(cause)

    def measure(self, counts: tuple[int, ...]) -> None:
        """Nothing: the chip has no encoders, and reports what it puts out."""

    def feed(self, received: bytes) -> None:
        """Bytes from the host; during the boot they are lost."""
        if not self._boot_left:
            self.chip.feed(received)

    def step(self, dt: float) -> None:
        """Lets `dt` seconds pass."""
        cycles = round(dt * CLOCK_HZ)
        booting = min(self._boot_left, cycles)
        self._boot_left -= booting
        if cycles > booting:
            self.chip.run(cycles - booting)

    def take_output(self) -> bytes:
        """The bytes for the host since the last call."""
        return self.chip.take()

    def _flash(self) -> None:
        """Another program for other settings, on a chip that was never used."""
        table = _flash_table(self.settings)
        self.program = firmware_build.firmware(header(self.settings), table)
        library = firmware_build.simulator() / 'chip.so'
        self.chip = Chip(library, self.program, self.settings.baud)
        self._flashed = self.settings

    def _read_edges(self) -> None:
        for cycle, channel, level in self.chip.edges().tolist():
            if level:
                self._risen[channel] = cycle
            else:
                self._widths[channel] = cycle - self._risen[channel]


def _flash_table(settings: BoardSettings) -> str:
    if settings.table is None:
        return ''
    return flash_text(settings.table, 'a test', settings.can_loop)
