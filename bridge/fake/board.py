"""The fake board: the board's own program, in this process. Bytes in, bytes out, and `step(dt)`.

It is compiled from firmware/core, as the chip's is; firmware/host stands where the chip has its
timers, pins and serial line. No port and no clock. The simulated chip has the same three methods.
"""

import contextlib
import ctypes
from collections.abc import Callable
from typing import Protocol, TypeAlias

from bridge.fake.board_settings import BoardSettings
from bridge.fake.program import FlashTable, Wires, program
from bridge.protocol import Mode, ResetCause
from manipulator.errors import InvalidInput

HIGHEST_U16 = 0xFFFF
OUTPUT_BYTES = 1024
BLANK = b'\xff'


class AnyBoard(Protocol):
    """The board's program in this process (`Board`), or on a simulated chip.

    battery_mv: what its divider measures now. is_stop_open: the stop button's contact.
    """

    settings: BoardSettings
    battery_mv: int
    is_stop_open: bool

    @property
    def pulses(self) -> tuple[float | None, ...]:
        """Pulse width in counts by channel, None where no pulse goes out."""

    @property
    def rest(self) -> float:
        """Seconds until it does something by itself: begins a period of pulses, with a STATE."""

    def reset(self, cause: ResetCause) -> None:
        """Starts again: silent for the boot, then disarmed and knowing nothing."""

    def measure(self, counts: tuple[int, ...]) -> None:
        """What its encoders read from now on, by channel."""

    def feed(self, received: bytes) -> None:
        """Bytes from the host."""

    def step(self, dt: float) -> None:
        """Lets `dt` seconds pass."""

    def take_output(self) -> bytes:
        """The bytes for the host since the last call."""


MakeBoard: TypeAlias = Callable[[BoardSettings, int], AnyBoard]
"""Of settings and the battery's voltage in mV."""


class Board:
    """One board on a line; one thread at a time.

    memory: what its EEPROM holds when it is switched on; a blank one where nothing is given.
    """

    def __init__(
        self, settings: BoardSettings, battery_mv: int = 7600, memory: bytes = b''
    ) -> None:
        self.settings = settings
        self._program = program()
        self._wires = Wires()
        self.memory = memory
        self.battery_mv = battery_mv
        self._wires.machine = settings.machine
        self._load_table()
        self._host = self._program.host_new(ctypes.byref(self._wires))
        if not self._host:
            raise MemoryError('no memory for a board')
        self._output = ctypes.create_string_buffer(OUTPUT_BYTES)
        self.reset(ResetCause.POWER_ON)

    def __del__(self) -> None:
        with contextlib.suppress(AttributeError):  # where __init__ has not come so far
            self._program.host_free(self._host)

    def reset(self, cause: ResetCause) -> None:
        """Starts again: silent for the boot, then disarmed and knowing nothing."""
        self._boot_left_us, self._rest_us = self.settings.boot_us, 0
        self._wires.machine = self.settings.machine
        self._program.host_reset(self._host, cause)

    @property
    def battery_mv(self) -> int:
        """What its divider measures now."""
        return int(self._wires.battery_mv)

    @battery_mv.setter
    def battery_mv(self, value: int) -> None:
        self._wires.battery_mv = min(max(value, 0), HIGHEST_U16)

    @property
    def is_stop_open(self) -> bool:
        """The stop button's contact, which stops while it is open."""
        return bool(self._wires.is_stop_open)

    @is_stop_open.setter
    def is_stop_open(self, value: bool) -> None:
        self._wires.is_stop_open = value

    @property
    def is_start_closed(self) -> bool:
        """The start button's contact, which acts when it closes."""
        return bool(self._wires.is_start_closed)

    @is_start_closed.setter
    def is_start_closed(self, value: bool) -> None:
        self._wires.is_start_closed = value

    def measure(self, counts: tuple[int, ...]) -> None:
        """What its encoders read from now on, by channel; until the first call it has none."""
        self._wires.has_encoders = True
        self._wires.positions[: len(counts)] = [min(max(c, 0), HIGHEST_U16) for c in counts]

    @property
    def memory(self) -> bytes:
        """The EEPROM, which outlives a reset."""
        return bytes(self._wires.memory)

    @memory.setter
    def memory(self, value: bytes) -> None:
        cells = self._wires.memory
        if len(value) > len(cells):
            raise InvalidInput(f'memory: {len(value)} bytes, the board has {len(cells)}')
        cells[:] = value.ljust(len(cells), BLANK)

    @property
    def mode(self) -> Mode:
        """What the board is doing."""
        return Mode(self._wires.mode)

    @property
    def pulses(self) -> tuple[float | None, ...]:
        """Pulse width in counts by channel, None where no pulse goes out."""
        widths = self._wires.pulses[: len(self.settings.count_ranges)]
        return tuple(width or None for width in widths)

    def feed(self, received: bytes) -> None:
        """Bytes from the host; during the boot they are lost."""
        if not self._boot_left_us:
            self._program.host_feed(self._host, received, len(received))

    def step(self, dt: float) -> None:
        """Lets `dt` seconds pass; a period of pulses, and a STATE, begins every 20 ms."""
        passed_us = round(dt * 1e6)
        boot_us = min(self._boot_left_us, passed_us)
        self._boot_left_us -= boot_us
        if not self._boot_left_us:
            self._rest_us = self._program.host_run(self._host, passed_us - boot_us)

    @property
    def rest(self) -> float:
        """See AnyBoard."""
        return 1e-6 * (self._boot_left_us or self._rest_us)

    def take_output(self) -> bytes:
        """The bytes for the host since the last call."""
        length = self._program.host_take(self._host, self._output, OUTPUT_BYTES)
        return self._output.raw[:length]

    def _load_table(self) -> None:
        """What was loaded with the program; kept here, as the program only points to it."""
        table, counts = self.settings.table, self.settings.table_counts
        if table is not None:
            self._table_counts = (ctypes.c_uint16 * len(counts))(*counts)
            self._wires.table = FlashTable(len(table.rows), table.step_ms, self.settings.can_loop)
            self._wires.table_counts = self._table_counts
