"""Makes a simulated board believe that it has been running for days.

The board's clock is one counter of pulse periods (`periods` in chip_clock.c, 32 bits);
microseconds and milliseconds follow from it and wrap earlier.
"""

import subprocess

from firmware.simulator.board import SimulatedBoard

SIZE = 4
PERIOD_MS = 20
US_WRAP, MS_WRAP = 2**32 // 20_000, 2**32 // PERIOD_MS
"""In pulse periods: 71.6 minutes and 49.7 days."""
PERIODS_WRAP = 2**32


def put_forward(board: SimulatedBoard, periods: int) -> None:
    """So many pulse periods pass at once; the board's loop takes them for one."""
    address = _address(board)
    now = sum(board.chip.peek(address + i) << 8 * i for i in range(SIZE))
    then = now + periods
    for i in range(SIZE):
        board.chip.poke(address + i, then >> 8 * i & 0xFF)


def _address(board: SimulatedBoard) -> int:
    """Where it stands in RAM."""
    command = ['avr-nm', '-S', str(board.program)]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    symbols = [line.split() for line in lines]
    (address,) = (
        int(words[0], 16) & 0xFFFF
        for words in symbols
        if len(words) == 4 and words[3].split('.')[0] == 'periods' and int(words[1], 16) == SIZE
    )
    return address
