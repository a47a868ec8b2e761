"""Which setpoints a session lets out, and what it learns from the board's answers to them."""

import pytest

from bridge.events import FaultReported, Phase
from bridge.frames import encode
from bridge.protocol import Disarm, FaultCode, Setpoint, Stop
from bridge.session import Session
from manipulator.errors import Refused

PARK = (3000,) * 6


def test_setpoints_before_arming_are_refused_here(line):
    line.run(0.4)
    with pytest.raises(Refused, match='accepts no setpoints now: disarmed'):
        line.setpoint()
    assert line.sent == []


def test_no_setpoint_overtakes_a_stop(armed):
    armed.session.send_command(Stop(), armed.now)
    with pytest.raises(Refused):
        armed.setpoint()


@pytest.mark.parametrize('command', [Disarm(), Stop()])
def test_no_setpoint_follows_an_acknowledged_disarm_or_stop(armed, command):
    armed.session.send_command(command, armed.now)
    while armed.session._pending is not None:
        armed.run(0.005)
    assert not armed.session.accepts_setpoints
    assert armed.run(0.2) == []


def test_setpoints_are_not_repeated(armed):
    armed.setpoint()
    armed.run(1.0)
    assert [message for message in armed.sent if isinstance(message, Setpoint)] == [
        Setpoint(200, PARK)
    ]


def test_round_trips_leave_out_the_stay_on_the_board(armed):
    for _ in range(40):
        armed.setpoint()
        armed.run(0.01)
    trips = armed.session.round_trips.seconds
    assert len(trips) >= 15
    assert max(trips) <= 0.006  # the line above hands bytes over every 5 ms


def test_faults_are_reported(armed):
    armed.setpoint((9999,) * 6)
    (event,) = armed.run(0.05)
    assert isinstance(event, FaultReported)
    assert (event.fault.code, event.fault.value) == (FaultCode.OUT_OF_RANGE, 9999)


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
