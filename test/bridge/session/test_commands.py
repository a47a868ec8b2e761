"""Every command that a session took ends: acknowledged, or failed with the reason."""

import random
from dataclasses import replace

import pytest

from bridge.events import Acknowledged, CommandFailed, Disconnected
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.protocol import (
    Ack,
    Arm,
    Clear,
    Disarm,
    Finish,
    Hello,
    Mode,
    Play,
    ResetCause,
    Result,
    Stop,
)
from manipulator.errors import Refused

PARK = (3000,) * 6


def test_commands_are_acknowledged(line):
    assert line.arm() == [Acknowledged(Arm(PARK))]
    assert line.session.accepts_setpoints
    assert line.command(Stop()) == [Acknowledged(Stop())]
    assert not line.session.accepts_setpoints
    assert line.command(Clear()) == [Acknowledged(Clear())]
    assert line.command(Disarm()) == [Acknowledged(Disarm())]


@pytest.mark.parametrize(
    ('before', 'command', 'mode'),
    [
        ((), Arm(PARK), Mode.ARMING),
        ((Stop(),), Clear(), Mode.DISARMED),
        ((Arm(PARK), Stop()), Clear(), Mode.DISARMED),
        ((Arm(PARK),), Stop(), Mode.STOPPED),
        ((Arm(PARK),), Disarm(), Mode.DISARMED),
    ],
)
def test_what_is_acknowledged_can_be_seen_in_the_state(line, before, command, mode):
    line.run(0.4)
    for earlier in before:
        line.command(earlier)
    events = line.session.send_command(command, line.now)
    while not events:
        events = line.run(0.005)
    assert events == [Acknowledged(command)]
    assert line.session.state.mode is mode
    assert line.sent.count(command) == 1


def test_an_obeyed_command_does_not_fail_where_another_command_comes_before_the_state(
    line,
):
    line.run(0.4)
    line.session.send_command(Arm(PARK), line.now)
    line.board.feed(line.session.take_output())
    assert line.session.receive(line.board.take_output(), line.now) == []
    assert line.board.mode is Mode.ARMING
    assert line.command(Stop()) == [Acknowledged(Arm(PARK)), Acknowledged(Stop())]


@pytest.mark.parametrize(('command', 'mode'), [(Stop(), Mode.STOPPED), (Disarm(), Mode.DISARMED)])
def test_the_mode_is_known_from_the_acknowledgement_before_a_state_reports_it(
    armed, command, mode
):
    before = armed.session.state
    armed.session.send_command(command, armed.now)
    (frame,) = FrameReader().feed(armed.session.take_output())
    armed.session.receive(encode(Ack(frame.sequence, Result.OK), 1), armed.now)
    assert armed.session.state == replace(before, mode=mode)
    with pytest.raises(Refused, match=f'accepts no setpoints now: {mode.name.lower()}'):
        armed.setpoint()


def test_a_clear_that_is_acknowledged_changes_no_mode(armed):
    before = armed.session.state
    armed.session.send_command(Clear(), armed.now)
    (frame,) = FrameReader().feed(armed.session.take_output())
    armed.session.receive(encode(Ack(frame.sequence, Result.OK), 1), armed.now)
    assert armed.session.state == before


def test_refusal_of_a_command_comes_with_its_reason(armed):
    armed.command(Stop())
    (failed,) = armed.command(Arm(PARK))
    assert failed == CommandFailed(Arm(PARK), 'the board is stopped: clear the stop first')


def test_a_lost_command_is_repeated_until_it_is_received(armed):
    armed.loses = True
    armed.session.send_command(Stop(), armed.now)
    armed.run(0.25)
    armed.loses = False
    assert armed.run(0.15) == [Acknowledged(Stop())]
    assert armed.sent.count(Stop()) == 4


def test_a_command_that_is_never_received_fails(armed):
    armed.loses = True
    armed.session.send_command(Disarm(), armed.now)
    (failed,) = armed.run(1.0)
    assert failed == CommandFailed(Disarm(), 'no answer from the board after 4 tries')
    assert armed.sent.count(Disarm()) == 4


def test_a_stop_takes_the_place_of_what_is_in_progress(line):
    line.run(0.4)
    line.loses = True
    line.session.send_command(Arm(PARK), line.now)
    line.run(0.05)
    line.loses = False
    events = line.command(Stop())
    assert events == [CommandFailed(Arm(PARK), 'STOP came after it'), Acknowledged(Stop())]
    with pytest.raises(Refused, match='STOP is in progress'):
        line.session.send_command(Stop(), line.now)
        line.session.send_command(Arm(PARK), line.now)


def test_a_lost_port_fails_what_was_in_progress(armed):
    armed.session.send_command(Stop(), armed.now)
    events = armed.session.closed('gone', armed.now)
    assert events == [CommandFailed(Stop(), 'gone'), Disconnected('gone')]
    assert armed.session.take_output() == b''


@pytest.mark.parametrize('seed', range(5))
def test_every_command_ends_whatever_happens_meanwhile(line, seed):
    rng = random.Random(seed)
    mishaps = {
        'lose': lambda: setattr(line, 'loses', rng.random() < 0.5),
        'mute': lambda: setattr(line, 'is_mute', rng.random() < 0.5),
        'reset': lambda: line.board.reset(ResetCause.WATCHDOG),
        'other': lambda: line.session.receive(
            encode(Hello(2, ResetCause.EXTERNAL, 6, 0), 1), line.now
        ),
        'replug': lambda: [
            *line.session.closed('unplugged', line.now),
            *line.session.opened(line.now),
        ],
        'nothing': lambda: None,
    }
    taken = 0
    for _ in range(60):
        command = rng.choice([Arm(PARK), Disarm(), Clear(), Stop(), Play(2, True), Finish()])
        try:
            events = line.session.send_command(command, line.now)
        except Refused:
            line.loses = line.is_mute = False
            line.run(1.0)
            continue
        taken += 1
        events = [*events, *line.run(rng.choice([0.0, 0.005, 0.03]))]
        events = [*events, *(mishaps[rng.choice(list(mishaps))]() or [])]
        events += line.run(0.7)
        ends = [e for e in events if isinstance(e, Acknowledged | CommandFailed)]
        assert command in [e.command for e in ends]
    assert taken > 20
