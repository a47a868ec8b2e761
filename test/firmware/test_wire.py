"""wire.c on this computer: the same frames as the Python side of the line, byte for byte."""

import ctypes
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bridge import cobs, protocol
from bridge.fake.program import program
from bridge.frames import MAX_WIRE_BYTES, checksum
from bridge.protocol import Program
from manipulator.errors import ProtocolError

GOLDEN = Path(__file__).parents[1] / 'bridge' / 'golden_frames.txt'
PROTOCOL_H = Path(__file__).parents[2] / 'firmware' / 'core' / 'protocol.h'


class Frame(ctypes.Structure):
    _fields_ = (
        ('type', ctypes.c_uint8),
        ('sequence', ctypes.c_uint16),
        ('length', ctypes.c_uint8),
        ('payload', ctypes.c_uint8 * 56),
    )


@pytest.fixture(scope='module')
def wire():
    return program()


def decode(wire, stuffed):
    """(type, sequence, payload), or None where the bytes are damaged."""
    frame = Frame()
    wire.wire_decode.restype = ctypes.c_bool
    if not wire.wire_decode(stuffed, len(stuffed), ctypes.byref(frame)):
        return None
    return frame.type, frame.sequence, bytes(frame.payload[: frame.length])


def encode(wire, code, sequence, payload):
    frame = Frame(code, sequence, len(payload), (ctypes.c_uint8 * 56)(*payload))
    out = (ctypes.c_uint8 * MAX_WIRE_BYTES)()
    return bytes(out[: wire.wire_encode(ctypes.byref(frame), out)])


def golden():
    rows = [line.split() for line in GOLDEN.read_text().splitlines()]
    return [(row[0], int(row[1]), bytes.fromhex(row[2])) for row in rows if row and row[0] != '#']


@pytest.mark.parametrize(('name', 'sequence', 'bytes_on_wire'), golden())
def test_golden_frames_are_read_and_written(wire, name, sequence, bytes_on_wire):
    code, read_sequence, payload = decode(wire, bytes_on_wire[:-1])
    assert read_sequence == sequence
    assert encode(wire, code, sequence, payload) == bytes_on_wire


@given(code=st.integers(0, 255), sequence=st.integers(0, 65535), payload=st.binary(max_size=56))
def test_any_frame_is_what_python_writes(wire, code, sequence, payload):
    body = bytes([code]) + sequence.to_bytes(2, 'little') + payload
    expected = cobs.encode(body + checksum(body).to_bytes(2, 'little'))
    assert encode(wire, code, sequence, payload) == expected + b'\0'
    assert decode(wire, expected) == (code, sequence, payload)


@given(stuffed=st.binary(max_size=62))
def test_any_bytes_are_a_frame_or_damaged_as_python_decides(wire, stuffed):
    stuffed = stuffed.replace(b'\0', b'\1')
    try:
        content = cobs.decode(stuffed)
    except ProtocolError:
        content = b''
    is_whole = len(content) >= 5 and checksum(content[:-2]) == int.from_bytes(
        content[-2:], 'little'
    )
    assert (decode(wire, stuffed) is not None) == is_whole


def test_every_single_bit_error_is_noticed(wire):
    for _, _, bytes_on_wire in golden():
        for bit in range(8 * (len(bytes_on_wire) - 1)):
            damaged = bytearray(bytes_on_wire[:-1])
            damaged[bit // 8] ^= 1 << bit % 8
            assert decode(wire, bytes(damaged)) is None


ENUMS = {
    'MODE': protocol.Mode,
    'KNOWN': protocol.Known,
    'FLAG': protocol.Flag,
    'RESULT': protocol.Result,
    'FAULT': protocol.FaultCode,
    'PROGRAM': Program,
}


def test_protocol_h_says_what_the_messages_say():
    text = PROTOCOL_H.read_text()
    for prefix, kind in ENUMS.items():
        written = dict(re.findall(rf'\b{prefix}_(\w+) = (\d+)', text))
        assert written
        for name, value in written.items():
            assert kind[name] == int(value), f'{prefix}_{name}'
        assert written.keys() == {m.name for m in kind}
    for name in (
        'PROTOCOL_VERSION',
        'MAX_JOINTS',
        'NO_JOINT',
        'MIN_DEADLINE_MS',
        'MAX_DEADLINE_MS',
    ):
        (value,) = re.findall(rf'#define {name} (\d+)', text)
        assert getattr(protocol, name) == int(value)
