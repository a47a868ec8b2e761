"""Messages to bytes on the wire and back (docs/protocol.md).

A frame is type (u8), sequence (u16), payload and CRC-16 (polynomial 0x1021, initial 0xFFFF),
little endian, COBS stuffed and ended by a zero byte: less than 64 bytes in all, as the Arduino
core's receive ring is that long.
"""

import binascii
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from bridge import cobs
from bridge.protocol import (
    MAX_JOINTS,
    Ack,
    Arm,
    Clear,
    CycleAxis,
    Disarm,
    Fault,
    FaultCode,
    Finish,
    Flag,
    Hello,
    Joint,
    Known,
    Message,
    Mode,
    Play,
    ResetCause,
    Result,
    Setpoint,
    State,
    Stop,
    TableBegin,
    TableEnd,
    TableRow,
)
from manipulator.errors import InvalidInput, ProtocolError

MAX_WIRE_BYTES = 63
DELIMITER = b'\0'

_HEAD = struct.Struct('<BH')
_CRC = struct.Struct('<H')
_U16 = struct.Struct('<H')
_HELLO = struct.Struct('<BBBI')
_STATE = struct.Struct('<HHBBBHHHH')
_ACK = struct.Struct('<HB')
_FAULT = struct.Struct('<BBH')
_CYCLE_AXIS = struct.Struct('<BfHf')
_TABLE_BEGIN = struct.Struct('<HH')
_PLAY = struct.Struct('<B?')


@dataclass(frozen=True)
class Frame:
    """A message with the sequence number that it travelled under."""

    sequence: int
    message: Message


class Unreadable(ProtocolError):
    """A whole frame, CRC and all, whose type or payload means nothing here."""


def encode(message: Message, sequence: int) -> bytes:
    """The bytes on the wire, delimiter included; InvalidInput where a value does not fit."""
    code, pack = _ENCODERS[type(message)]
    try:
        content = _HEAD.pack(code, sequence) + pack(message)
    except struct.error as error:
        raise InvalidInput(f'{message} under sequence {sequence} does not fit: {error}') from error
    wire = cobs.encode(content + _CRC.pack(checksum(content))) + DELIMITER
    if len(wire) > MAX_WIRE_BYTES:
        raise InvalidInput(f'{message} takes {len(wire)} bytes, at most {MAX_WIRE_BYTES}')
    return wire


def decode(stuffed: bytes) -> Frame:
    """The frame in the bytes before a delimiter.

    ProtocolError where the bytes are damaged, Unreadable where they are whole but no message.
    """
    content = cobs.decode(stuffed)
    if len(content) < _HEAD.size + _CRC.size:
        raise ProtocolError(f'{len(content)} bytes are too short for a frame')
    body, crc = content[: -_CRC.size], content[-_CRC.size :]
    if _CRC.pack(checksum(body)) != crc:
        raise ProtocolError('CRC does not match')
    code, sequence = _HEAD.unpack_from(body)
    if code not in _DECODERS:
        raise Unreadable(f'unknown frame type 0x{code:02x}')
    try:
        return Frame(sequence, _DECODERS[code](body[_HEAD.size :]))
    except (struct.error, ValueError) as error:
        raise Unreadable(f'frame type 0x{code:02x}: {error}') from error


def checksum(content: bytes) -> int:
    """CRC-16 as avr-libc's _crc_xmodem_update from 0xFFFF: b'123456789' gives 0x29B1."""
    return binascii.crc_hqx(content, 0xFFFF)


def table_crc(rows: Sequence[tuple[int, ...]]) -> int:
    """The CRC of a whole table: of all its counts, little endian, row by row."""
    return checksum(b''.join(count.to_bytes(2, 'little') for row in rows for count in row))


def _pack_counts(counts: tuple[int, ...]) -> bytes:
    if not 1 <= len(counts) <= MAX_JOINTS:
        raise struct.error(f'{len(counts)} joints, 1 to {MAX_JOINTS} fit')
    return struct.pack(f'<{len(counts)}H', *counts)


def _unpack_counts(payload: bytes) -> tuple[int, ...]:
    count = len(payload) // 2
    if not 1 <= count <= MAX_JOINTS:
        raise ValueError(f'{count} joints, 1 to {MAX_JOINTS} fit')
    return struct.unpack(f'<{count}H', payload)


def _unpack_setpoint(payload: bytes) -> Setpoint:
    (deadline_ms,) = _U16.unpack_from(payload)
    return Setpoint(deadline_ms, _unpack_counts(payload[_U16.size :]))


def _known_bytes(joints: int) -> int:
    """Of the two bits a joint in a STATE: two for up to eight joints."""
    return max(2, -(-joints // 4))


def _pack_state(state: State) -> bytes:
    head = _STATE.pack(
        state.echo,
        state.echo_age_us,
        state.mode,
        state.flags,
        state.fault,
        state.battery_mv,
        state.bad_frames,
        state.overruns,
        state.refused,
    )
    known = sum(joint.known << 2 * i for i, joint in enumerate(state.joints))
    head += known.to_bytes(_known_bytes(len(state.joints)), 'little')
    return head + _pack_counts(tuple(joint.count for joint in state.joints))


def _unpack_state(payload: bytes) -> State:
    echo, age, mode, flags, fault, battery, bad, over, refused = _STATE.unpack_from(payload)
    rest = payload[_STATE.size :]
    count = next((n for n in range(1, MAX_JOINTS + 1) if len(rest) == _known_bytes(n) + 2 * n), 0)
    known = int.from_bytes(rest[: _known_bytes(count)], 'little')
    counts = _unpack_counts(rest[_known_bytes(count) :] if count else b'')
    joints = tuple(Joint(Known(known >> 2 * i & 3), count) for i, count in enumerate(counts))
    modes = Mode(mode), Flag(flags), FaultCode(fault)
    return State(echo, age, *modes, battery, bad, over, refused, joints)


def _unpack_hello(payload: bytes) -> Hello:
    version, cause, joint_count, uptime_ms = _HELLO.unpack(payload)
    return Hello(version, ResetCause(cause), joint_count, uptime_ms)


def _unpack_ack(payload: bytes) -> Ack:
    sequence, result = _ACK.unpack(payload)
    return Ack(sequence, Result(result))


def _unpack_fault(payload: bytes) -> Fault:
    code, joint, value = _FAULT.unpack(payload)
    return Fault(FaultCode(code), joint, value)


def _unpack_row(payload: bytes) -> TableRow:
    (index,) = _U16.unpack_from(payload)
    return TableRow(index, _unpack_counts(payload[_U16.size :]))


def _unpack_empty(message: Message) -> Callable[[bytes], Message]:
    def unpack(payload: bytes) -> Message:
        if payload:
            raise ValueError(f'{len(payload)} bytes of payload, needs none')
        return message

    return unpack


_Encoder: TypeAlias = tuple[int, Callable[..., bytes]]

_ENCODERS: dict[type, _Encoder] = {
    Setpoint: (0x01, lambda m: _U16.pack(m.deadline_ms) + _pack_counts(m.counts)),
    Arm: (0x02, lambda m: _pack_counts(m.park)),
    Disarm: (0x03, lambda m: b''),
    Stop: (0x04, lambda m: b''),
    Clear: (0x05, lambda m: b''),
    CycleAxis: (
        0x06,
        lambda m: _CYCLE_AXIS.pack(m.axis, m.amplitude, m.frequency_mhz, m.phase),
    ),
    TableBegin: (0x07, lambda m: _TABLE_BEGIN.pack(m.rows, m.step_ms)),
    TableRow: (0x08, lambda m: _U16.pack(m.index) + _pack_counts(m.counts)),
    TableEnd: (0x09, lambda m: _U16.pack(m.crc)),
    Play: (0x0A, lambda m: _PLAY.pack(m.program, m.is_loop)),
    Finish: (0x0B, lambda m: b''),
    Hello: (0x81, lambda m: _HELLO.pack(m.version, m.reset_cause, m.joint_count, m.uptime_ms)),
    State: (0x82, _pack_state),
    Ack: (0x83, lambda m: _ACK.pack(m.sequence, m.result)),
    Fault: (0x84, lambda m: _FAULT.pack(m.code, m.joint, m.value)),
}

_DECODERS: dict[int, Callable[[bytes], Message]] = {
    0x01: _unpack_setpoint,
    0x02: lambda payload: Arm(_unpack_counts(payload)),
    0x03: _unpack_empty(Disarm()),
    0x04: _unpack_empty(Stop()),
    0x05: _unpack_empty(Clear()),
    0x06: lambda payload: CycleAxis(*_CYCLE_AXIS.unpack(payload)),
    0x07: lambda payload: TableBegin(*_TABLE_BEGIN.unpack(payload)),
    0x08: _unpack_row,
    0x09: lambda payload: TableEnd(*_U16.unpack(payload)),
    0x0A: lambda payload: Play(*_PLAY.unpack(payload)),
    0x0B: _unpack_empty(Finish()),
    0x81: _unpack_hello,
    0x82: _unpack_state,
    0x83: _unpack_ack,
    0x84: _unpack_fault,
}
