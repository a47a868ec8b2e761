"""The messages of host and board, as values (docs/protocol.md has the frame table).

Counts are the position of a joint on the wire, unsigned 16 bit: for a servo, half microseconds
of pulse. Joints are in the order of the board's channels.
"""

import enum
from dataclasses import dataclass
from typing import TypeAlias

PROTOCOL_VERSION = 1
MAX_JOINTS = 18
"""As many as a STATE of 63 bytes holds. The chip has fewer channels: hexarm/board/header.py."""
MIN_DEADLINE_MS, MAX_DEADLINE_MS = 1, 2000


class Mode(enum.IntEnum):
    """What the board is doing; only ARMED and HOLDING accept setpoints."""

    DISARMED = 0  # no pulses
    ARMING = 1  # servo after servo is energised at the park pose
    ARMED = 2  # follows setpoints, waits 2 s for the first one
    HOLDING = 3  # the last setpoint's deadline passed; the next one is followed again
    STOPPED = 4  # STOP: holds where it is, until CLEAR
    FAULT = 5  # holds where it is, until CLEAR
    CHECKING = 6  # computes whether a program can be played; nothing moves
    PLAYING = 7  # moves by itself, host or no host


class Known(enum.IntEnum):
    """What the count of a joint in a STATE means."""

    UNKNOWN = 0  # no pulse since power-up or release
    COMMANDED = 1  # what was last put out; a hobby servo reports nothing
    MEASURED = 2


class Flag(enum.IntFlag):
    """Bits of a STATE."""

    DEADLINE_PASSED = 1
    UNDERVOLTAGE = 2
    SLEWING = 4  # the joints lag behind the setpoint, at the servos' rated speed


class ResetCause(enum.IntFlag):
    """Why the board started: the bits of the AVR's MCUSR."""

    POWER_ON = 1
    EXTERNAL = 2
    BROWN_OUT = 4
    WATCHDOG = 8
    JTAG = 16


class Result(enum.IntEnum):
    """What became of a command."""

    OK = 0
    STALE = 1  # its sequence is not newer than the last one's
    STOPPED = 2  # clear the stop first
    FAULT = 3  # clear the fault first
    UNDERVOLTAGE = 4
    OUT_OF_RANGE = 5
    WRONG_JOINTS = 6
    TOO_LARGE = 7  # more rows than the board's memory holds
    BAD_TABLE = 8  # a row out of turn, a row too few, or the CRC over the whole does not fit
    TOO_FAST = 9  # a servo could not follow
    NOT_ARMED = 10
    NOT_AT_START = 11  # the joints are too far from where the program begins
    NO_PROGRAM = 12


REASONS = {
    Result.STALE: 'the board has received a newer frame',
    Result.STOPPED: 'the board is stopped: clear the stop first',
    Result.FAULT: 'the board has a fault: clear it first',
    Result.UNDERVOLTAGE: 'the battery is too low',
    Result.OUT_OF_RANGE: 'a position is out of range',
    Result.WRONG_JOINTS: 'the board has another number of joints',
    Result.TOO_LARGE: 'the table has more rows than the board can hold',
    Result.BAD_TABLE: 'the table did not arrive whole',
    Result.TOO_FAST: 'a servo could not follow',
    Result.NOT_ARMED: 'the servos are off',
    Result.NOT_AT_START: 'the joints are too far from where the program begins',
    Result.NO_PROGRAM: 'the board has no such program, or is playing',
}
"""Why a command was not obeyed, for people."""


class FaultCode(enum.IntEnum):
    """Why a frame was refused, or why the mode is FAULT."""

    NONE = 0
    OUT_OF_RANGE = 1  # joint and value name the count
    WRONG_JOINTS = 2  # value: how many counts the frame held
    STALE = 3  # value: the frame's sequence
    NOT_ARMED = 4  # value: the mode
    BAD_DEADLINE = 5  # value: the deadline in ms
    UNKNOWN_TYPE = 6  # value: the frame's type
    MALFORMED = 7  # value: the frame's type
    UNDERVOLTAGE = 8  # value: millivolts; the mode becomes FAULT
    OUT_OF_REACH = 9  # value: when in the program, in ms; the program has ended
    TOO_FAST = 10  # value: when in the program, in ms; the program has ended


NO_JOINT = 255


@dataclass(frozen=True)
class Setpoint:
    """Host: be there, and expect the next one within the deadline."""

    deadline_ms: int
    counts: tuple[int, ...]


@dataclass(frozen=True)
class Arm:
    """Host: energise servo by servo at the park counts; where all are on, stay and follow."""

    park: tuple[int, ...]


@dataclass(frozen=True)
class Disarm:
    """Host: no more pulses."""


@dataclass(frozen=True)
class Stop:
    """Host: halt, and stay halted until CLEAR."""


@dataclass(frozen=True)
class Clear:
    """Host: forget stop and fault; nothing moves."""


@dataclass(frozen=True)
class Hello:
    """Board: announces itself, after the boot and while the host is silent."""

    version: int
    reset_cause: ResetCause
    joint_count: int
    uptime_ms: int


@dataclass(frozen=True)
class Joint:
    """One joint of a STATE; `count` is 0 where it is UNKNOWN."""

    known: Known
    count: int


@dataclass(frozen=True)
class State:
    """Board, 50 times a second: the last accepted frame's sequence and age, and all it knows."""

    echo: int
    echo_age_us: int
    mode: Mode
    flags: Flag
    fault: FaultCode
    battery_mv: int
    bad_frames: int
    overruns: int
    refused: int
    joints: tuple[Joint, ...]


@dataclass(frozen=True)
class Ack:
    """Board: the answer to every message of a host but SETPOINT."""

    sequence: int
    result: Result


@dataclass(frozen=True)
class Fault:
    """Board: a frame was refused whole, or the mode became FAULT."""

    code: FaultCode
    joint: int
    value: int


def is_newer(sequence: int, last: int) -> bool:
    """The half-window rule: newer by 1 to 32767, modulo 65536."""
    return 0 < (sequence - last) & 0xFFFF < 0x8000


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

Command: TypeAlias = Arm | Disarm | Stop | Clear | ProgramPart | Play | Finish
Message: TypeAlias = Setpoint | Command | Hello | State | Ack | Fault
