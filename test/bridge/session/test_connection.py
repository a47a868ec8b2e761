"""Whom a session talks to: from the board's first HELLO to its silence or restart, and back."""

import pytest

from bridge.events import CommandFailed, Connected, Disconnected, Incompatible, Phase
from bridge.frames import encode
from bridge.protocol import Arm, Disarm, Hello, Mode, ResetCause
from manipulator.errors import Refused

PARK = (3000,) * 6


def test_host_is_silent_until_the_hello(line):
    line.run(0.28)
    with pytest.raises(Refused, match='no board is connected'):
        line.command(Arm(PARK))
    assert line.session.phase is Phase.WAITING
    assert line.sent == []


def test_connects_with_hello_and_first_state(line):
    (connected,) = line.run(0.4)
    assert isinstance(connected, Connected)
    assert line.session.state.mode is Mode.DISARMED


def test_junk_before_hello_does_no_harm(line):
    line.session.receive(b'\xf0\x00boot loader 7\x00\x05\x11', line.now)
    assert [type(event) for event in line.run(0.4)] == [Connected]


def test_another_protocol_version_is_not_talked_to(line_of):
    line = line_of(version=2)
    assert line.run(1.5) == [Incompatible('the board has protocol 2, this host 1')]
    with pytest.raises(Refused):
        line.command(Arm(PARK))
    assert line.sent == []


def test_another_joint_count_is_not_talked_to(line_of):
    line = line_of(joint_count=5)
    assert line.run(1.5) == [Incompatible('the board has 6 joints, the machine 5')]
    assert line.sent == []


def test_a_board_that_never_speaks_is_reported(line):
    line.is_mute = True
    (event,) = line.run(5.5)
    assert 'no HELLO came' in event.reason


def test_a_board_of_another_version_fails_what_was_in_progress(armed):
    armed.is_mute = True
    armed.session.send_command(Disarm(), armed.now)
    other = Hello(2, ResetCause.EXTERNAL, 6, 10)
    events = armed.session.receive(encode(other, 1), armed.now)
    assert [type(event) for event in events] == [CommandFailed, Incompatible]


def test_a_board_that_falls_silent_is_lost_and_found_again(armed):
    armed.is_mute = True
    assert armed.run(0.6) == [Disconnected('no frame from the board for 0.5 s')]
    assert not armed.session.accepts_setpoints
    armed.board.take_output()
    armed.is_mute = False
    armed.sent.clear()
    (connected,) = armed.run(1.0)
    assert isinstance(connected, Connected)
    assert armed.sent == []


def test_a_board_that_fell_silent_and_stays_away_is_reported_again(armed):
    armed.is_mute = True
    lost, missed, again = armed.run(0.6 + 5.0 + 5.0)
    assert lost == Disconnected('no frame from the board for 0.5 s')
    assert missed == again == Disconnected('the port is open, but no HELLO came for 5 s')
    with pytest.raises(Refused, match='no board is connected: waiting'):
        armed.command(Disarm())


def test_a_restart_of_the_board_is_noticed_while_setpoints_flow(armed):
    armed.board.reset(ResetCause.WATCHDOG)
    events = []
    for _ in range(100):
        if armed.session.accepts_setpoints:
            armed.setpoint()
        events += armed.run(0.01)
    assert events[0] == Disconnected('the board has restarted (cause: WATCHDOG)')
    assert isinstance(events[-1], Connected)
    assert armed.board.pulses == (None,) * 6


def test_a_restart_just_after_the_first_hello_is_noticed(line):
    line.run(0.65)
    line.board.reset(ResetCause.BROWN_OUT)
    events = line.run(0.4)
    assert events[0] == Disconnected('the board has restarted (cause: BROWN_OUT)')


def test_the_idle_hellos_of_a_board_are_no_restart(line):
    line.run(0.4)
    assert line.run(20.0) == []


def test_a_wrapped_uptime_is_no_restart(line):
    line.run(0.4)
    line.session.hello = Hello(1, ResetCause.POWER_ON, 6, 0xFFFF_FFFF - 100)
    line.session._hello_at = line.now
    line.now += 0.2
    wrapped = encode(Hello(1, ResetCause.POWER_ON, 6, 99), 1)
    assert line.session.receive(wrapped, line.now) == []
