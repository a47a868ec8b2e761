"""A stop is wanted until it is cleared: whatever the line, the board or the bridge do."""

import contextlib

import pytest

from bridge.events import Acknowledged, CommandFailed
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.protocol import Ack, Arm, Clear, Mode, ResetCause, Result, Stop
from manipulator.errors import Refused

PARK = (3000,) * 6


def test_a_stop_is_repeated_until_the_board_receives_it(armed):
    armed.loses = True
    armed.command(Stop())
    failed, *again = armed.run(3.0)
    assert len(again) > 3  # reported after every four tries
    assert failed == CommandFailed(Stop(), 'no answer from the board after 4 tries')
    with pytest.raises(Refused):
        armed.setpoint()
    armed.loses = False
    assert armed.run(0.2) == [Acknowledged(Stop())]
    assert armed.board.mode is Mode.STOPPED


def test_a_stop_that_is_refused_lets_no_setpoint_out_either(armed):
    armed.session.send_command(Stop(), armed.now)
    (frame,) = FrameReader().feed(armed.session.take_output())
    armed.session.receive(encode(Ack(frame.sequence, Result.STALE), 1), armed.now)
    assert not armed.session.accepts_setpoints
    armed.run(0.1)
    assert armed.board.mode is Mode.STOPPED


def test_a_stop_that_found_no_board_stops_it_when_it_comes_and_must_be_cleared(line):
    with pytest.raises(Refused, match='no board'):
        line.session.send_command(Stop(), line.now)
    assert line.sent == []
    line.run(0.5)
    assert line.board.mode is Mode.STOPPED
    line.command(Arm(PARK))
    assert line.board.mode is Mode.STOPPED
    assert line.command(Clear()) == [Acknowledged(Clear())]
    line.arm()
    assert line.session.accepts_setpoints


def test_a_stop_outlives_a_restart_of_the_board(armed):
    armed.command(Stop())
    armed.board.reset(ResetCause.BROWN_OUT)
    armed.run(1.0)
    assert armed.board.mode is Mode.STOPPED
    armed.command(Clear())
    armed.run(0.5)
    assert armed.board.mode is Mode.DISARMED
    assert armed.sent.count(Stop()) == 2


def test_hammering_stop_and_clear_ends_as_the_last_one_commands(armed):
    for _ in range(20):
        armed.session.send_command(Stop(), armed.now)
        armed.run(0.01)
        with contextlib.suppress(Refused):
            armed.session.send_command(Clear(), armed.now)
        armed.session.send_command(Stop(), armed.now)
    armed.run(0.5)
    assert armed.board.mode is Mode.STOPPED
    assert not armed.session.accepts_setpoints
    armed.command(Clear())
    assert armed.board.mode is Mode.ARMED
    assert armed.session.accepts_setpoints
