import random

from hypothesis import given
from hypothesis import strategies as st

from bridge import cobs
from bridge.frames import checksum, encode
from bridge.framing import FrameReader
from bridge.protocol import Setpoint, Stop

FRAMES = [encode(Setpoint(200, (3000 + k,) * 6), k) for k in range(20)]


@given(st.lists(st.integers(1, 40), min_size=1), st.randoms(use_true_random=False))
def test_frames_arrive_however_the_bytes_are_split(sizes, rng):
    stream, reader, got = b''.join(FRAMES), FrameReader(), []
    while stream:
        size = rng.choice(sizes)
        got += reader.feed(stream[:size])
        stream = stream[size:]
    assert [frame.sequence for frame in got] == list(range(20))
    assert (reader.bad_frames, reader.overruns) == (0, 0)


def test_junk_before_a_frame_costs_at_most_that_frame():
    reader = FrameReader()
    assert reader.feed(b'\x07boot loader' + FRAMES[0]) == []
    assert reader.bad_frames == 1
    assert len(reader.feed(FRAMES[1])) == 1


def test_repeated_delimiters_are_no_frames():
    reader = FrameReader()
    assert len(reader.feed(b'\0\0\0' + FRAMES[0] + b'\0\0')) == 1
    assert reader.bad_frames == 0


def test_endless_noise_is_one_overrun_and_is_not_kept():
    reader = FrameReader()
    for _ in range(1000):
        assert reader.feed(b'\xff' * 1000) == []
        assert len(reader._pending) < 64
    assert reader.feed(b'\0' + FRAMES[3])[0].sequence == 3
    assert (reader.bad_frames, reader.overruns) == (0, 1)


def test_a_frame_of_63_bytes_is_read_and_one_of_64_is_an_overrun():
    def frame(size):
        body = bytes([0x7E, 1, 0]) + b'\5' * (size - 7)
        return cobs.encode(body + checksum(body).to_bytes(2, 'little')) + b'\0'

    for size, overruns in ((63, 0), (64, 1)):
        reader = FrameReader()
        assert len(frame(size)) == size
        reader.feed(frame(size))
        assert (reader.overruns, reader.bad_frames) == (overruns, 0)


def test_a_damaged_frame_is_counted_and_the_next_one_is_read():
    reader = FrameReader()
    damaged = bytearray(FRAMES[0])
    damaged[5] ^= 0x10
    got = reader.feed(bytes(damaged) + FRAMES[1])
    assert [frame.sequence for frame in got] == [1]
    assert reader.bad_frames == 1


def test_a_crc_alone_is_a_damaged_frame_and_the_next_one_is_read():
    reader = FrameReader()
    crc_of_nothing = b'\x03\xff\xff\0'
    assert reader.feed(crc_of_nothing + FRAMES[1])[0].sequence == 1
    assert reader.bad_frames == 1


def test_whole_frames_without_a_meaning_are_passed_over():
    reader = FrameReader()
    # A DISARM whose type was replaced before the CRC was made: type 0x7e.
    unknown = encode_with_type(0x7E)
    assert reader.feed(unknown + encode(Stop(), 9))[0].sequence == 9
    assert (reader.bad_frames, reader.overruns) == (0, 0)


@given(st.binary(max_size=400), st.integers(0, 2**32))
def test_mutated_streams_never_raise_and_every_loss_is_counted(noise, seed):
    rng = random.Random(seed)
    stream = bytearray(b''.join(FRAMES))
    for byte in noise:
        stream[rng.randrange(len(stream))] = byte
    reader = FrameReader()
    got = reader.feed(bytes(stream) + b'\0')
    known = {frame.sequence: frame for frame in FrameReader().feed(b''.join(FRAMES))}
    assert all(known[frame.sequence] == frame for frame in got)
    if len(got) < len(FRAMES):
        assert reader.bad_frames + reader.overruns > 0


def encode_with_type(code):
    body = bytes([code, 1, 0])
    return cobs.encode(body + checksum(body).to_bytes(2, 'little')) + b'\0'
