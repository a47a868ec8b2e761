"""Bytes that no board of ours would send: damaged, random, endless."""

import os
import pty
import random
import time
import tty
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bridge.events import StateReceived
from bridge.fake.board import Board
from bridge.fake.board_settings import BoardSettings
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.link import Link
from bridge.link_thread import LinkThread, SerialPort
from bridge.protocol import Mode, ResetCause, Stop
from bridge.session import Phase, Session
from manipulator.errors import Refused

SETTINGS = BoardSettings(((1100, 4900),) * 6, (12_600.0,) * 6, boot_us=0)
LINES = (Path(__file__).parent / 'golden_frames.txt').read_text().splitlines()
GOLDEN = [bytes.fromhex(line.split()[2]) for line in LINES if line and line[0] != '#']
CHUNKS = st.lists(
    st.one_of(st.binary(max_size=200), st.sampled_from(GOLDEN), st.just(bytes(300))), max_size=20
)


def damaged(wire, chance):
    """One of: a byte changed, cut out, put in, two frames run together, a piece repeated."""
    k = chance.randrange(len(wire))
    return chance.choice(
        [
            wire[:k] + bytes([chance.randrange(256)]) + wire[k + 1 :],
            wire[:k] + wire[k + 1 :],
            wire[:k] + bytes([chance.randrange(256)]) + wire[k:],
            wire[:k] + chance.choice(GOLDEN),
            wire[:k] * chance.randint(1, 9) + wire,
        ]
    )


def feed_all(pieces):
    """Both ends of the line get every piece; what is kept of them stays small."""
    reader, board, session = FrameReader(), Board(SETTINGS), Session(6)
    session.opened(0.0)
    for k, piece in enumerate(pieces):
        now = 0.01 * k
        reader.feed(piece)
        board.feed(piece)
        board.step(0.01)
        session.receive(piece, now)
        session.tick(now)
        session.take_output()
        assert len(reader._pending) < 64
        assert len(board.take_output()) <= 1024
    return board, session


@settings(deadline=None)
@given(pieces=CHUNKS)
def test_after_any_bytes_a_board_obeys_a_stop_and_a_session_knows_a_new_board(pieces):
    board, session = feed_all(pieces)
    board.feed(b'\0' + encode(Stop(), 1))
    assert board.mode is Mode.STOPPED
    board.reset(ResetCause.POWER_ON)
    board.step(0.1)
    session.receive(b'\0' + board.take_output(), 1.0)
    assert session.phase is Phase.READY


def test_of_damaged_golden_frames_none_is_taken_for_another():
    chance = random.Random(3)
    wires = [damaged(chance.choice(GOLDEN), chance) for _ in range(20_000)]
    feed_all(wires)
    reader = FrameReader()
    taken = 0
    for wire in wires:
        frames = reader.feed(wire if wire.endswith(b'\0') else wire + b'\0')
        taken += sum(not any(_is_part_of(f, g) for g in GOLDEN) for f in frames)
    assert taken <= 3, 'a CRC of 16 bits lets one damaged frame in 65536 through'


def _is_part_of(frame, golden):
    (good,) = FrameReader().feed(golden)
    return frame == good


@given(noise=st.binary(max_size=500))
@settings(deadline=None)
def test_noise_neither_arms_a_board_nor_makes_a_host_ready(noise):
    board, session = feed_all([noise])
    assert board.mode is Mode.DISARMED
    assert session.phase is Phase.WAITING


@pytest.mark.parametrize('noise', [b'\0', b'\x01\0', b'\xff', b'noise without end, '])
def test_endless_noise_takes_little_of_the_processor_and_requests_are_received(noise):
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    name, seen = os.ttyname(theirs), []
    rate = 50_000
    link = Link(Session(6), lambda event, now: seen.append(event), bytes_per_second=rate)
    thread = LinkThread(lambda: SerialPort(name, 250_000), link)
    os.set_blocking(ours, False)
    sent = 0
    thread.start()
    try:
        begin, used = time.monotonic(), time.thread_time()
        total = time.process_time()
        while time.monotonic() < begin + 0.3:
            try:
                sent += os.write(ours, noise * (4096 // len(noise)))
            except BlockingIOError:
                time.sleep(0.002)
        elapsed = time.monotonic() - begin
        cost = time.process_time() - total - (time.thread_time() - used)
        with pytest.raises(Refused):
            thread.request(Stop()).result(60.0)
    finally:
        thread.close()
        os.close(ours)
        os.close(theirs)
    assert sent < rate * elapsed + 3 * 65_536
    assert cost < 0.5 * elapsed
    assert not any(isinstance(event, StateReceived) for event in seen)
