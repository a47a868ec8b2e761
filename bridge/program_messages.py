"""What the host says of programs that the board plays by itself (docs/protocol.md)."""

import enum
from dataclasses import dataclass
from typing import TypeAlias


class Program(enum.IntEnum):
    """What a board can play without a host."""

    CYCLE = 1  # periodic motion about home; the board solves the inverse kinematics
    TABLE = 2  # the one that was uploaded
    FLASH_TABLE = 3  # the one that was built in


@dataclass(frozen=True)
class CycleAxis:
    """Host: the sine on one axis (0 to 5: x, y, z, roll, pitch, yaw) of the cycle about home.

    amplitude in metres or radians and phase in radians, both with 32 bits; frequency in
    thousandths of a hertz.
    """

    axis: int
    amplitude: float
    frequency_mhz: int
    phase: float


@dataclass(frozen=True)
class TableBegin:
    """Host: forget the table; a new one of `rows` rows follows, step_ms apart."""

    rows: int
    step_ms: int


@dataclass(frozen=True)
class TableRow:
    """Host: one row of it; rows come in order, from 0."""

    index: int
    counts: tuple[int, ...]


@dataclass(frozen=True)
class TableEnd:
    """Host: that was all; the CRC is over all counts, little endian, row by row."""

    crc: int


@dataclass(frozen=True)
class Play:
    """Host: check and play a `Program`, once or in a loop, host or no host."""

    program: int
    is_loop: bool


@dataclass(frozen=True)
class Finish:
    """Host: end the program that is being played, smoothly."""


ProgramPart: TypeAlias = CycleAxis | TableBegin | TableRow | TableEnd
