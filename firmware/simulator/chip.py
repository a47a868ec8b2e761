"""chip.so through ctypes: a simulated ATmega2560 that runs as far as requested."""

import ctypes
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from manipulator.errors import ManipulatorError

CLOCK_HZ = 16_000_000
CYCLES_A_COUNT = 8
EDGE = np.dtype([('cycle', '<u8'), ('channel', 'u1'), ('level', 'u1')], align=True)
ROOM = 1 << 18


class ChipCrashed(ManipulatorError):
    """The program ran into nowhere."""


class Chip:
    """A chip with a program. Times in clock cycles since it was made."""

    def __init__(self, library: Path, program: Path, baud: int) -> None:
        self._call = _functions(library)
        self._chip = self._call.chip_new(str(program).encode(), baud)
        if not self._chip:
            raise ManipulatorError(f'{program} is no program')
        self._bytes = (ctypes.c_uint8 * ROOM)()
        self._edges = np.zeros(ROOM, EDGE)

    def close(self) -> None:
        """Frees it; nothing else may be called then."""
        if self._chip:
            self._call.chip_free(self._chip)
            self._chip = None

    def __del__(self) -> None:
        self.close()

    @property
    def cycle(self) -> int:
        """The time."""
        return int(self._call.chip_cycle(self._chip))

    @property
    def seconds(self) -> float:
        """The same in seconds."""
        return self.cycle / CLOCK_HZ

    @property
    def backlog(self) -> int:
        """Bytes for the chip that are not yet on the line."""
        return int(self._call.chip_backlog(self._chip))

    @property
    def watchdog_resets(self) -> int:
        """How often the watchdog has reset it."""
        return int(self._call.chip_watchdog_resets(self._chip))

    @property
    def lost_bytes(self) -> int:
        """Bytes that a real chip would have lost, because they were not taken in time."""
        return int(self._call.chip_lost_bytes(self._chip))

    def reset(self, cause: int) -> None:
        """Starts again, with these bits in MCUSR."""
        self._call.chip_reset(self._chip, cause)

    def run(self, cycles: int) -> None:
        """Lets time pass."""
        if not self._call.chip_run(self._chip, self.cycle + cycles):
            raise ChipCrashed(f'the chip has crashed at cycle {self.cycle}')

    def feed(self, received: bytes) -> None:
        """Bytes for the chip, sent at the line's rate from now on."""
        self._call.chip_feed(self._chip, received, len(received))

    def take(self) -> bytes:
        """What the chip has sent since the last call."""
        length = self._call.chip_take(self._chip, self._bytes, ROOM)
        return bytes(self._bytes[:length])

    def edges(self) -> NDArray[np.void]:
        """The edges of the servo pins since the last call: cycle, channel, level."""
        pointer = self._edges.ctypes.data_as(ctypes.c_void_p)
        count = self._call.chip_edges(self._chip, pointer, ROOM)
        edges: NDArray[np.void] = self._edges[:count].copy()
        return edges

    def set_battery_pin(self, millivolts: int) -> None:
        """The voltage at A0."""
        self._call.chip_set_battery_pin(self._chip, millivolts)

    def set_button(self, pin: int, is_open: bool) -> None:
        """Pin 0 is the stop button, pin 1 the start button."""
        self._call.chip_set_button(self._chip, pin, is_open)

    def hang(self, with_interrupts: bool) -> None:
        """Catches the program in an endless loop."""
        self._call.chip_hang(self._chip, with_interrupts)

    def peek(self, address: int) -> int:
        """One byte of memory."""
        return int(self._call.chip_peek(self._chip, address))

    def poke(self, address: int, value: int) -> None:
        """Writes one byte of memory."""
        self._call.chip_poke(self._chip, address, value)


def _functions(library: Path) -> ctypes.CDLL:
    functions = ctypes.CDLL(str(library))
    chip, u8, u16, u32, u64 = (
        ctypes.c_void_p,
        ctypes.c_uint8,
        ctypes.c_uint16,
        ctypes.c_uint32,
        ctypes.c_uint64,
    )
    flag = ctypes.c_bool
    for name, result, arguments in (
        ('chip_new', chip, (ctypes.c_char_p, u32)),
        ('chip_free', None, (chip,)),
        ('chip_reset', None, (chip, u8)),
        ('chip_run', flag, (chip, u64)),
        ('chip_cycle', u64, (chip,)),
        ('chip_watchdog_resets', u32, (chip,)),
        ('chip_feed', None, (chip, ctypes.c_char_p, u32)),
        ('chip_backlog', u32, (chip,)),
        ('chip_take', u32, (chip, ctypes.c_void_p, u32)),
        ('chip_lost_bytes', u32, (chip,)),
        ('chip_edges', u32, (chip, ctypes.c_void_p, u32)),
        ('chip_set_battery_pin', None, (chip, u32)),
        ('chip_set_button', None, (chip, u8, flag)),
        ('chip_hang', None, (chip, flag)),
        ('chip_peek', u8, (chip, u16)),
        ('chip_poke', None, (chip, u16, u8)),
    ):
        function = getattr(functions, name)
        function.restype, function.argtypes = result, arguments
    return functions
