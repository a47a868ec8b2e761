"""link.c: when the program is busy and its receive ring full, only frames that lost bytes go.

On this computer the bytes arrive at once while the program is busy; on the chip that takes 10 ms.
"""

import random

import pytest

from bridge.fake.board import Board
from bridge.fake.board_settings import BoardSettings
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.protocol import Ack, Arm, Clear, Disarm, Mode, Result, State, Stop, TableRow

SETTINGS = BoardSettings(((1100, 4900),) * 6, (12_600.0,) * 6, boot_us=0)
RING = 255


@pytest.fixture
def board():
    board = Board(SETTINGS)
    board.step(0.01)
    board.take_output()
    return board


def answers(board):
    """(sequence, result) of each command that was obeyed or refused."""
    board.step(0.0)
    messages = [frame.message for frame in FrameReader().feed(board.take_output())]
    return [(m.sequence, m.result) for m in messages if isinstance(m, Ack)]


def feed_busy(board, received):
    """All at once, while the program is busy: what its ring cannot hold is lost."""
    board._program.host_receive(board._host, received, len(received))


def state(board):
    board.take_output()
    board.step(0.04)
    messages = [frame.message for frame in FrameReader().feed(board.take_output())]
    return [m for m in messages if isinstance(m, State)][-1]


def test_a_stop_that_arrived_whole_is_obeyed_when_what_comes_after_it_is_lost(board):
    frames = [encode(Stop(), 1), *(encode(Clear(), 2 + k) for k in range(58))]
    feed_busy(board, b''.join(frames))
    found = answers(board)
    assert found[0] == (1, Result.OK)
    assert [sequence for sequence, _ in found] == list(range(1, len(found) + 1))
    assert len(found) == RING // len(frames[1])
    board.feed(encode(Clear(), 100))
    assert (100, Result.OK) in answers(board)
    assert state(board).overruns == 1
    assert state(board).bad_frames == 0


def test_a_stop_that_comes_once_there_is_room_again_is_obeyed(board):
    feed_busy(board, b''.join(encode(Clear(), 1 + k) for k in range(60)))
    answers(board)
    assert board.mode is Mode.DISARMED
    board.feed(encode(Stop(), 100))
    assert (100, Result.OK) in answers(board)
    assert board.mode is Mode.STOPPED


@pytest.mark.parametrize('split', range(1, 7))
def test_a_frame_that_lost_its_middle_is_an_overrun_although_its_end_had_room(board, split):
    """Its first bytes filled the ring, its last ones come when the ring is empty again."""
    frames = b''.join(encode(Clear(), 1 + k) for k in range(35))
    cut, after = encode(Disarm(), 100), encode(Disarm(), 101)
    filling = frames + bytes(RING - len(frames) - split)
    feed_busy(board, filling + cut[:split] + cut[split : split + 1])
    assert len(answers(board)) == 35
    board.feed(cut[split + 1 :] + after)
    assert answers(board) == [(101, Result.OK)]
    found = state(board)
    assert (found.overruns, found.bad_frames) == (1, 0)


@pytest.mark.parametrize('seed', range(20))
def test_every_frame_whose_bytes_had_room_is_obeyed_and_no_other(board, seed):
    """The ring is filled and emptied again and again, and never a frame made of two."""
    rng = random.Random(seed)
    sequence = obeyed = 0
    for _ in range(30):
        room, kept = RING, []
        burst = b''
        while len(burst) < rng.choice([0, 200, 600]):
            sequence += 1
            message = rng.choice([Disarm(), Arm((3000,) * 6), TableRow(0, (3000,) * 6)])
            wire = encode(message, sequence).lstrip(b'\0')
            wire = b'\0' + wire if rng.random() < 0.3 else wire
            burst += wire
            if room >= len(wire):
                room -= len(wire)
                kept.append(sequence)
            else:
                room = 0
        feed_busy(board, burst)
        assert [s for s, _ in answers(board)] == kept
        obeyed += len(kept)
        board.take_output()
    assert obeyed > 40
    assert state(board).bad_frames == 0
