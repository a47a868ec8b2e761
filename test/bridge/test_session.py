import contextlib
import random

import pytest

from bridge.board import Board
from bridge.board_settings import BoardSettings
from bridge.events import (
    Acknowledged,
    CommandFailed,
    Connected,
    Disconnected,
    FaultReported,
    Incompatible,
    Phase,
    StateReceived,
)
from bridge.frames import encode
from bridge.framing import FrameReader
from bridge.messages import (
    Ack,
    Arm,
    Clear,
    Disarm,
    FaultCode,
    Hello,
    Mode,
    ResetCause,
    Result,
    Setpoint,
    Stop,
)
from bridge.program_messages import Finish, Play
from bridge.session import Session
from manipulator.errors import Refused

PARK = (3000,) * 6
SETTINGS = BoardSettings(((1100, 4900),) * 6, (12_600.0,) * 6, boot_us=300_000)


class Line:
    """A session and a board in one time; `loses` drops frames of the host."""

    def __init__(self, joint_count=6, **settings):
        self.board = Board(BoardSettings(**{**SETTINGS.__dict__, **settings}))
        self.session = Session(joint_count)
        self.now = 100.0
        self.session.opened(self.now)
        self.sent = []
        self.loses = False
        self.is_mute = False

    def run(self, seconds):
        """Events other than STATE."""
        events = []
        for _ in range(round(seconds / 0.005)):
            self.now += 0.005
            self.board.step(0.005)
            heard = b'' if self.is_mute else self.board.take_output()
            events += self.session.receive(heard, self.now) + self.session.tick(self.now)
            output = self.session.take_output()
            self.sent += [frame.message for frame in FrameReader().feed(output)]
            if not self.loses:
                self.board.feed(output)
        return [event for event in events if not isinstance(event, StateReceived)]

    def command(self, command):
        return self.session.send_command(command, self.now) + self.run(0.05)

    def setpoint(self, counts=PARK):
        self.session.send_setpoint(Setpoint(200, counts), self.now)

    def arm(self):
        self.run(0.4)
        events = self.command(Arm(PARK))
        self.run(1.0)
        return events


@pytest.fixture
def line():
    return Line()


@pytest.fixture
def armed(line):
    line.arm()
    return line


def test_host_is_silent_until_the_hello(line):
    line.run(0.28)
    with pytest.raises(Refused, match='no board to talk to'):
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


def test_commands_are_acknowledged(line):
    assert line.arm() == [Acknowledged(Arm(PARK))]
    assert line.session.accepts_setpoints
    assert line.command(Stop()) == [Acknowledged(Stop())]
    assert not line.session.accepts_setpoints
    assert line.command(Clear()) == [Acknowledged(Clear())]
    assert line.command(Disarm()) == [Acknowledged(Disarm())]


def test_refusal_of_a_command_comes_with_its_reason(armed):
    armed.command(Stop())
    (failed,) = armed.command(Arm(PARK))
    assert failed == CommandFailed(Arm(PARK), 'the board is stopped: clear the stop first')


def test_setpoints_before_arming_are_refused_here(line):
    line.run(0.4)
    with pytest.raises(Refused, match='takes no setpoints now: disarmed'):
        line.setpoint()
    assert line.sent == []


def test_no_setpoint_overtakes_a_stop(armed):
    armed.session.send_command(Stop(), armed.now)
    with pytest.raises(Refused):
        armed.setpoint()


def test_a_lost_command_is_repeated_until_it_is_heard(armed):
    armed.loses = True
    armed.session.send_command(Stop(), armed.now)
    armed.run(0.25)
    armed.loses = False
    assert armed.run(0.15) == [Acknowledged(Stop())]
    assert armed.sent.count(Stop()) == 4


def test_a_command_that_is_never_heard_fails(armed):
    armed.loses = True
    armed.session.send_command(Disarm(), armed.now)
    (failed,) = armed.run(1.0)
    assert failed == CommandFailed(Disarm(), 'no answer from the board after 4 tries')
    assert armed.sent.count(Disarm()) == 4


def test_a_stop_takes_the_place_of_what_is_under_way(line):
    line.run(0.4)
    line.loses = True
    line.session.send_command(Arm(PARK), line.now)
    line.run(0.05)
    line.loses = False
    events = line.command(Stop())
    assert events == [CommandFailed(Arm(PARK), 'STOP came after it'), Acknowledged(Stop())]
    with pytest.raises(Refused, match='STOP is under way'):
        line.session.send_command(Stop(), line.now)
        line.session.send_command(Arm(PARK), line.now)


def test_round_trips_leave_out_the_stay_on_the_board(armed):
    for _ in range(40):
        armed.setpoint()
        armed.run(0.01)
    trips = armed.session.round_trips.seconds
    assert len(trips) >= 15
    assert max(trips) <= 0.006  # the line above hands bytes over every 5 ms


def test_setpoints_are_not_repeated(armed):
    armed.setpoint()
    armed.run(1.0)
    assert [message for message in armed.sent if isinstance(message, Setpoint)] == [
        Setpoint(200, PARK)
    ]


def test_another_protocol_version_is_not_talked_to():
    line = Line(version=2)
    assert line.run(1.5) == [Incompatible('the board speaks protocol 2, this host 1')]
    with pytest.raises(Refused):
        line.command(Arm(PARK))
    assert line.sent == []


def test_another_joint_count_is_not_talked_to():
    line = Line(joint_count=5)
    assert line.run(1.5) == [Incompatible('the board has 6 joints, the machine 5')]
    assert line.sent == []


def test_a_board_that_never_speaks_is_said():
    line = Line()
    line.is_mute = True
    (event,) = line.run(5.5)
    assert 'no board said HELLO' in event.reason


def test_a_board_that_falls_silent_is_lost_and_found_again(armed):
    armed.is_mute = True
    assert armed.run(0.6) == [Disconnected('the board has been silent for 0.5 s')]
    assert not armed.session.accepts_setpoints
    armed.board.take_output()
    armed.is_mute = False
    armed.sent.clear()
    (connected,) = armed.run(1.0)
    assert isinstance(connected, Connected)
    assert armed.sent == []


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


@pytest.mark.parametrize('last', [5, 30_000, 40_000, 65_535])
def test_a_second_host_goes_on_from_the_first_ones_sequence(armed, last):
    armed.board.feed(encode(Setpoint(200, PARK), (armed.session._sequence + 20_000) & 0xFFFF))
    armed.board.feed(encode(Setpoint(200, PARK), last))
    armed.session = Session(6)
    armed.session.opened(armed.now)
    armed.run(1.0)
    assert armed.session.phase is Phase.READY
    armed.setpoint((3100,) * 6)
    armed.run(0.1)
    assert armed.board.pulses == (3100.0,) * 6


def test_faults_are_reported(armed):
    armed.setpoint((9999,) * 6)
    (event,) = armed.run(0.05)
    assert isinstance(event, FaultReported)
    assert (event.fault.code, event.fault.value) == (FaultCode.OUT_OF_RANGE, 9999)


def test_a_lost_port_fails_what_was_under_way(armed):
    armed.session.send_command(Stop(), armed.now)
    events = armed.session.closed('gone', armed.now)
    assert events == [CommandFailed(Stop(), 'gone'), Disconnected('gone')]
    assert armed.session.take_output() == b''


def test_a_wrapped_uptime_is_no_restart(line):
    line.run(0.4)
    line.session.hello = Hello(1, ResetCause.POWER_ON, 6, 0xFFFF_FFFF - 100)
    line.session._greeted_at = line.now
    line.now += 0.2
    wrapped = encode(Hello(1, ResetCause.POWER_ON, 6, 99), 1)
    assert line.session.receive(wrapped, line.now) == []


@pytest.mark.parametrize('command', [Disarm(), Stop()])
def test_no_setpoint_follows_an_acknowledged_disarm_or_stop(armed, command):
    armed.session.send_command(command, armed.now)
    while armed.session._pending is not None:
        armed.run(0.005)
    assert not armed.session.accepts_setpoints
    assert armed.run(0.2) == []


def test_a_stop_is_repeated_until_the_board_hears_it(armed):
    armed.loses = True
    armed.command(Stop())
    failed, *again = armed.run(3.0)
    assert len(again) > 3  # and it is said so each time that four tries more were in vain
    assert failed == CommandFailed(Stop(), 'no answer from the board after 4 tries yet')
    with pytest.raises(Refused):
        armed.setpoint()
    armed.loses = False
    assert armed.run(0.2) == [Acknowledged(Stop())]
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


def test_a_stop_that_an_earlier_bridge_was_asked_for_is_said(line):
    line.session = Session(6, is_stop_wanted=True)
    line.session.opened(line.now)
    line.run(0.6)
    assert line.session.state.mode is Mode.STOPPED
    line.command(Clear())
    line.run(0.2)
    assert not line.session.is_stop_wanted
    assert line.session.state.mode is Mode.DISARMED


def test_hammering_stop_and_clear_ends_as_the_last_one_says(armed):
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


def test_a_stop_that_is_refused_lets_no_setpoint_out_either(armed):
    armed.session.send_command(Stop(), armed.now)
    (frame,) = FrameReader().feed(armed.session.take_output())
    armed.session.receive(encode(Ack(frame.sequence, Result.STALE), 1), armed.now)
    assert not armed.session.accepts_setpoints
    armed.run(0.1)
    assert armed.board.mode is Mode.STOPPED


def test_a_board_of_another_version_fails_what_was_under_way(armed):
    armed.is_mute = True
    armed.session.send_command(Disarm(), armed.now)
    other = Hello(2, ResetCause.EXTERNAL, 6, 10)
    events = armed.session.receive(encode(other, 1), armed.now)
    assert [type(event) for event in events] == [CommandFailed, Incompatible]


@pytest.mark.parametrize('seed', range(5))
def test_every_command_ends_whatever_happens_meanwhile(seed):
    rng, line = random.Random(seed), Line()
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
