from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bridge import cobs
from bridge.frames import MAX_WIRE_BYTES, Frame, Unreadable, checksum, decode, encode
from bridge.protocol import (
    NO_JOINT,
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
    Mode,
    Play,
    Program,
    ResetCause,
    Result,
    Setpoint,
    State,
    Stop,
    TableBegin,
    TableEnd,
    TableRow,
    is_newer,
)
from manipulator.errors import InvalidInput, ProtocolError

PARK = (3000,) * 6
UNKNOWN = Joint(Known.UNKNOWN, 0)
MESSAGES = {
    'setpoint_six': Setpoint(200, (1100, 4900, 3000, 3001, 2999, 256)),
    'setpoint_one': Setpoint(1, (0,)),
    'setpoint_eight': Setpoint(1000, (65535,) * 8),
    'arm_six': Arm(PARK),
    'disarm': Disarm(),
    'stop': Stop(),
    'clear': Clear(),
    'cycle_axis': CycleAxis(5, 0.0625, 500, 0.25),
    'table_begin': TableBegin(448, 50),
    'table_row_six': TableRow(3, (1100, 4900, 3000, 3001, 2999, 256)),
    'table_end': TableEnd(0x29B1),
    'play_table_loop': Play(Program.TABLE, True),
    'finish': Finish(),
    'hello_power_on': Hello(1, ResetCause.POWER_ON, 6, 1500),
    'hello_watchdog': Hello(1, ResetCause.WATCHDOG | ResetCause.EXTERNAL, 6, 4_294_967_295),
    'state_fresh': State(
        0, 65535, Mode.DISARMED, Flag(0), FaultCode.NONE, 7600, 0, 0, 0, (UNKNOWN,) * 6
    ),
    'state_arming': State(
        7, 12345, Mode.ARMING, Flag(0), FaultCode.NONE, 7600, 1, 2, 3,
        (Joint(Known.COMMANDED, 3000), Joint(Known.MEASURED, 2990), *(UNKNOWN,) * 4),
    ),
    'state_fault': State(
        65535, 65535, Mode.FAULT, Flag.UNDERVOLTAGE | Flag.SLEWING, FaultCode.UNDERVOLTAGE, 5900,
        65535, 65535, 65535, (Joint(Known.MEASURED, 65535),) * 8,
    ),
    'ack_ok': Ack(258, Result.OK),
    'ack_stopped': Ack(65535, Result.STOPPED),
    'fault_range': Fault(FaultCode.OUT_OF_RANGE, 2, 4901),
    'fault_stale': Fault(FaultCode.STALE, NO_JOINT, 17),
}  # fmt: skip


def golden():
    lines = (Path(__file__).parent / 'golden_frames.txt').read_text().splitlines()
    rows = [line.split() for line in lines if line and not line.startswith('#')]
    return {name: (int(sequence), bytes.fromhex(wire)) for name, sequence, wire in rows}


def crc_by_definition(content):
    """Bit by bit: polynomial 0x1021, initial 0xFFFF, most significant bit first."""
    crc = 0xFFFF
    for byte in content:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def test_the_golden_frames_and_these_messages_are_the_same_set():
    assert golden().keys() == MESSAGES.keys()


@pytest.mark.parametrize('name', MESSAGES)
def test_golden_frame_is_written_and_read(name):
    sequence, wire = golden()[name]
    assert encode(MESSAGES[name], sequence) == wire
    assert wire[-1] == 0
    assert decode(wire[:-1]) == Frame(sequence, MESSAGES[name])


@pytest.mark.parametrize('name', MESSAGES)
def test_golden_frame_has_head_and_crc_by_definition(name):
    sequence, wire = golden()[name]
    content = cobs.decode(wire[:-1])
    assert int.from_bytes(content[1:3], 'little') == sequence
    assert int.from_bytes(content[-2:], 'little') == crc_by_definition(content[:-2])
    assert len(wire) <= MAX_WIRE_BYTES < 64


def test_checksum_is_the_one_of_avr_libc():
    assert checksum(b'123456789') == 0x29B1


def test_every_single_bit_error_is_noticed():
    stuffed = encode(MESSAGES['setpoint_six'], 4711)[:-1]
    for i in range(8 * len(stuffed)):
        damaged = bytearray(stuffed)
        damaged[i // 8] ^= 1 << i % 8
        with pytest.raises(ProtocolError):
            decode(bytes(damaged))


def framed(code, payload=b''):
    body = bytes([code, 5, 0]) + payload
    return cobs.encode(body + checksum(body).to_bytes(2, 'little'))


@pytest.mark.parametrize(
    ('code', 'payload', 'message'),
    [
        (0x10, b'', 'unknown frame type'),
        (0x7F, b'abc', 'unknown frame type'),
        (0x01, b'\1', 'frame type 0x01: '),  # no deadline
        (0x01, b'\1\0', 'frame type 0x01: '),  # no joints
        (0x01, b'\1\0\2', 'frame type 0x01: '),  # half a count
        (0x02, b'\1\0' * 19, 'frame type 0x02: '),  # 19 joints
        (0x03, b'\0', 'frame type 0x03: '),  # payload where none belongs
        (0x83, b'\1\0\x63', 'frame type 0x83: '),  # unknown result
    ],
)
def test_whole_frames_that_mean_nothing_are_distinguished_from_damaged_ones(
    code, payload, message
):
    with pytest.raises(Unreadable, match=message):
        decode(framed(code, payload))


@pytest.mark.parametrize('body', [b'', b'\3', b'\3\5'])
def test_a_content_too_short_for_a_frame_is_damage_though_its_crc_is_right(body):
    content = body + checksum(body).to_bytes(2, 'little')
    with pytest.raises(ProtocolError, match=f'{len(content)} bytes are too short') as caught:
        decode(cobs.encode(content))
    assert not isinstance(caught.value, Unreadable)


@pytest.mark.parametrize(
    ('message', 'sequence'),
    [
        (Setpoint(200, (70000,) * 6), 1),
        (Setpoint(-1, PARK), 1),
        (Setpoint(200, ()), 1),
        (Arm((1,) * 19), 1),
        (Stop(), 65536),
    ],
)
def test_what_does_not_fit_is_not_written(message, sequence):
    with pytest.raises(InvalidInput, match='does not fit'):
        encode(message, sequence)


@given(st.binary(max_size=70))
def test_random_bytes_are_a_protocol_error_or_a_frame(stuffed):
    try:
        frame = decode(stuffed)
    except ProtocolError:
        return
    assert decode(encode(frame.message, frame.sequence)[:-1]) == frame


@pytest.mark.parametrize(
    ('sequence', 'last', 'expected'),
    [(1, 0, True), (0, 0, False), (0, 1, False), (0, 65535, True), (32767, 0, True),
     (32768, 0, False), (65535, 0, False), (5, 65000, True)],
)  # fmt: skip
def test_half_window_rule(sequence, last, expected):
    assert is_newer(sequence, last) is expected
