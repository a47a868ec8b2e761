"""The board's program as a library: structures (firmware/core/machine.h, host/host.h), calls."""

import ctypes
import functools
from pathlib import Path

import bridge
from bridge.protocol import MAX_JOINTS
from manipulator.errors import ManipulatorError

LIBRARY = Path(bridge.__file__).with_name('_board.abi3.so')
LEGS = 6
MEMORY_BYTES = 160

Vectors = ctypes.c_float * LEGS * 3
"""Coordinate by coordinate, of all legs."""
Counts = ctypes.c_uint16 * MAX_JOINTS


class CrankLegs(ctypes.Structure):
    """The legs of a crank platform side by side; metres, radians, base frame but for `end`."""

    _fields_ = (
        ('centre', Vectors),
        ('normal', Vectors),
        ('tangent', Vectors),
        ('up', Vectors),
        ('end', Vectors),
        ('crank', ctypes.c_float * LEGS),
        ('rod', ctypes.c_float * LEGS),
        ('middle', ctypes.c_float * LEGS),
    )


class CrankServo(ctypes.Structure):
    """Its servo: radians, counts, counts a radian."""

    _fields_ = (
        ('channel', ctypes.c_uint8),
        ('centre', ctypes.c_float),
        ('centre_count', ctypes.c_float),
        ('scale', ctypes.c_float),
    )


class CrankHexapod(ctypes.Structure):
    """The kinematics by which the board plays cycles; all zero: it knows none."""

    _fields_ = (
        ('is_known', ctypes.c_bool),
        ('home_position', ctypes.c_float * 3),
        ('home_rotation', ctypes.c_float * 9),
        ('minimum_height', ctypes.c_float),
        ('crank_lowest', ctypes.c_float * LEGS),
        ('crank_highest', ctypes.c_float * LEGS),
        ('legs', CrankLegs),
        ('servos', CrankServo * LEGS),
    )


class Machine(ctypes.Structure):
    """What the program knows of its machine; counts by channel."""

    _fields_ = (
        ('protocol_version', ctypes.c_uint8),
        ('joint_count', ctypes.c_uint8),
        ('releases_on_link_loss', ctypes.c_bool),
        ('arm_interval_ms', ctypes.c_uint16),
        ('minimum_battery_mv', ctypes.c_uint16),
        ('baud', ctypes.c_uint32),
        ('lowest_counts', Counts),
        ('highest_counts', Counts),
        ('step_counts', ctypes.c_float * MAX_JOINTS),
        ('hexapod', CrankHexapod),
    )


class FlashTable(ctypes.Structure):
    """A table that was loaded with the program."""

    _fields_ = (
        ('rows', ctypes.c_uint16),
        ('step_ms', ctypes.c_uint16),
        ('can_loop', ctypes.c_bool),
    )


class Wires(ctypes.Structure):
    """What a board is wired to: this side writes all but `pulses` and `mode`."""

    _fields_ = (
        ('machine', Machine),
        ('table', FlashTable),
        ('table_counts', ctypes.POINTER(ctypes.c_uint16)),
        ('battery_mv', ctypes.c_uint16),
        ('is_stop_open', ctypes.c_bool),
        ('is_start_closed', ctypes.c_bool),
        ('has_encoders', ctypes.c_bool),
        ('positions', Counts),
        ('memory', ctypes.c_uint8 * MEMORY_BYTES),
        ('pulses', Counts),
        ('mode', ctypes.c_uint8),
    )


class ProgramMissing(ManipulatorError):
    """The library is not there, or another one than these structures are of."""


@functools.cache
def program() -> ctypes.PyDLL:
    """The library, opened once; ProgramMissing where it is not there, or does not fit.

    Its calls hold Python's lock: the boards of a process share the program's variables.
    """
    try:
        library = ctypes.PyDLL(str(LIBRARY))
    except OSError as error:
        raise ProgramMissing(f"the fake board's program: {error}: install hexarm anew") from error
    _declare(library)
    if library.host_size_of_wires() != ctypes.sizeof(Wires):
        raise ProgramMissing(f'{LIBRARY} is of another version of hexarm: install hexarm anew')
    return library


def _declare(library: ctypes.PyDLL) -> None:
    host, text, u8, u32 = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_uint8, ctypes.c_uint32
    for name, result, arguments in (
        ('host_size_of_wires', u32, ()),
        ('host_new', host, (ctypes.POINTER(Wires),)),
        ('host_free', None, (host,)),
        ('host_reset', None, (host, u8)),
        ('host_run', u32, (host, u32)),
        ('host_feed', None, (host, text, u32)),
        ('host_receive', None, (host, text, u32)),
        ('host_take', u32, (host, text, u32)),
    ):
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
