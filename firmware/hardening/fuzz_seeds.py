"""Inputs from which the fuzzer starts (fuzz.c): what an honest host does, as its acts."""

import math
import sys
from collections.abc import Iterator
from pathlib import Path

from bridge import cobs
from bridge.frames import encode, table_crc
from bridge.protocol import (
    Arm,
    Clear,
    Command,
    CycleAxis,
    Disarm,
    Finish,
    Play,
    Program,
    Setpoint,
    Stop,
    TableBegin,
    TableEnd,
    TableRow,
)

PARK = (3000,) * 6
NEAR, FAR = (3100, 2900) * 3, (4800, 1200) * 3
ROWS = [tuple(round(3000 + 90 * math.sin(0.6 * k + i)) for i in range(6)) for k in range(11)]
BATTERY, CONTACTS, FLASH_TABLE, FRAME, PASS = 0x00, 0x10, 0x93, 0xA0, 0x80
STOP_OPEN, START_CLOSED = 1, 2
LOW_BATTERY = 10
HEAD, CRC = 3, 2
"""Bytes of a frame around its payload."""


def frame(message: Setpoint | Command) -> bytes:
    """The act that sends it."""
    content = cobs.decode(encode(message, 0)[:-1])
    payload = content[HEAD:-CRC]
    return bytes([FRAME, content[0], len(payload)]) + payload


def passing(seconds: float) -> bytes:
    """The acts that let time pass."""
    periods = round(50 * seconds)
    return b''.join(bytes([PASS, min(periods - k, 255)]) for k in range(0, periods, 255))


ARMED = frame(Arm(PARK)) + passing(0.5)
PRESSED = bytes([CONTACTS | START_CLOSED]) + passing(0.1) + bytes([CONTACTS]) + passing(0.1)


def seeds() -> Iterator[bytes]:
    """One input for each thing that a board does."""
    yield ARMED + b''.join(frame(Setpoint(200, c)) + passing(0.3) for c in (NEAR, FAR, PARK))
    yield ARMED + frame(Setpoint(100, FAR)) + passing(0.06) + frame(Stop()) + frame(Clear())
    yield ARMED + frame(Setpoint(100, FAR)) + frame(Disarm()) + passing(0.1) + ARMED
    yield ARMED + bytes([BATTERY, LOW_BATTERY]) + passing(0.7) + frame(Clear())
    yield ARMED + bytes([CONTACTS | STOP_OPEN]) + passing(0.1) + PRESSED + frame(Clear())
    rows = b''.join(frame(TableRow(index, row)) for index, row in enumerate(ROWS))
    table = frame(TableBegin(len(ROWS), 100)) + rows + frame(TableEnd(table_crc(ROWS)))
    yield (
        table + frame(Arm(ROWS[0])) + passing(0.5) + frame(Play(Program.TABLE, False)) + passing(3)
    )
    yield table + PRESSED + passing(4) + PRESSED + passing(2)
    cycle = frame(CycleAxis(2, 0.003, 1000, 0.2)) + frame(CycleAxis(5, 0.05, 500, 0.0))
    yield (
        cycle
        + ARMED
        + frame(Play(Program.CYCLE, True))
        + passing(6)
        + frame(Finish())
        + passing(2)
    )
    yield (
        frame(CycleAxis(0, 0.03, 500, 0.0)) + ARMED + frame(Play(Program.CYCLE, True)) + passing(2)
    )
    yield bytes([FLASH_TABLE, 100]) + ARMED + frame(Play(Program.FLASH_TABLE, True)) + passing(3)
    yield bytes([FLASH_TABLE, 100]) + PRESSED + passing(2)


def main() -> None:
    """Writes them into the folder that the command line names."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for index, seed in enumerate(seeds()):
        (folder / f'seed_{index}').write_bytes(seed)


if __name__ == '__main__':
    main()
