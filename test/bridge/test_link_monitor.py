import math

import numpy as np
import pytest

from bridge.calibration import Calibration
from bridge.events import (
    Acknowledged,
    Connected,
    Disconnected,
    FaultReported,
    Opened,
    Phase,
    StateReceived,
)
from bridge.link_monitor import Latencies, LinkMonitor, percentiles_ms
from bridge.protocol import (
    Arm,
    Fault,
    FaultCode,
    Flag,
    Hello,
    Joint,
    Known,
    Mode,
    ResetCause,
    State,
)
from bridge.servo_config import BoardConfig
from bridge.session import Session
from hexarm import machines

HELLO = Hello(1, ResetCause.POWER_ON, 6, 300)
PARK = (3000,) * 6


def state(mode=Mode.ARMED, counts=PARK, fault=FaultCode.NONE):
    joints = tuple(
        Joint(Known.UNKNOWN, 0) if count is None else Joint(Known.COMMANDED, count)
        for count in counts
    )
    return State(0, 0, mode, Flag(0), fault, 7600, 0, 0, 0, joints)


@pytest.fixture
def monitor():
    config = BoardConfig.from_machine(machines.read('robocake'))
    return LinkMonitor(Session(6), Calibration.from_config(config.servos))


def receive(monitor, received, now=0.0):
    monitor.session.phase = Phase.READY
    monitor.session.state = received
    monitor.note(StateReceived(received), now)


def test_words_from_the_port_to_the_board(monitor):
    assert monitor.status.state == 'disconnected'
    monitor.session.opened(0.0)
    monitor.note(Opened(), 0.0)
    assert monitor.status.state == 'booting'
    monitor.note(Disconnected('no HELLO came'), 5.0)
    assert (monitor.status.state, monitor.status.reason) == ('disconnected', 'no HELLO came')


@pytest.mark.parametrize(
    ('mode', 'word'),
    [
        (Mode.DISARMED, 'disarmed'),
        (Mode.ARMING, 'arming'),
        (Mode.ARMED, 'enabled'),
        (Mode.HOLDING, 'holding'),
        (Mode.STOPPED, 'stopped'),
        (Mode.FAULT, 'fault'),
    ],
)
def test_one_word_for_each_mode(monitor, mode, word):
    monitor.note(Connected(HELLO), 0.0)
    monitor.note(Acknowledged(Arm(PARK)), 0.0)
    receive(monitor, state(mode))
    assert monitor.status.state == word


@pytest.mark.parametrize('mode', [Mode.DISARMED, Mode.ARMING, Mode.ARMED, Mode.PLAYING])
def test_there_is_nothing_to_clear_unless_a_stop_is_still_to_be_sent(monitor, mode):
    receive(monitor, state(mode))
    assert monitor.is_clear
    monitor.session.is_stop_requested = True
    assert not monitor.is_clear


@pytest.mark.parametrize('mode', [Mode.STOPPED, Mode.FAULT])
def test_a_stop_and_a_fault_are_to_be_cleared_and_an_absent_board_is_to_be_asked(monitor, mode):
    assert not monitor.is_clear
    receive(monitor, state(mode))
    assert not monitor.is_clear


def test_a_board_that_somebody_else_armed_is_not_enabled(monitor):
    monitor.note(Connected(HELLO), 0.0)
    receive(monitor, state(Mode.ARMED))
    assert monitor.status.state == 'unclaimed'
    monitor.note(Acknowledged(Arm(PARK)), 0.0)
    assert monitor.status.state == 'enabled'
    monitor.note(Disconnected('gone'), 0.0)
    monitor.note(Connected(HELLO), 0.0)
    receive(monitor, state(Mode.ARMED))
    assert monitor.status.state == 'unclaimed'


def test_the_fault_is_named(monitor):
    receive(monitor, state(Mode.FAULT, fault=FaultCode.UNDERVOLTAGE))
    assert monitor.status.reason == 'the battery is too low'


def test_unknown_joints_are_distinguished_from_known_ones(monitor):
    assert len(monitor.unknown_joints) == 6
    receive(monitor, state(Mode.ARMING, (3000, 3000, None, None, None, None)))
    assert monitor.joints.is_known == (True, True, False, False, False, False)
    assert monitor.unknown_joints == ('crank_3', 'crank_4', 'crank_5', 'crank_6')
    assert np.all(np.isfinite(monitor.joints.velocities))


def test_velocity_is_the_change_over_the_state_periods(monitor):
    receive(monitor, state(), 0.0)
    # 21 counts are a degree; the second STATE came a little late, as they do.
    receive(monitor, state(counts=(3021,) * 6), 0.023)
    assert monitor.joints.velocities[0] == pytest.approx(math.radians(1) / 0.02)
    assert monitor.joints.velocities[1] == pytest.approx(-math.radians(1) / 0.02)
    receive(monitor, state(counts=(3063,) * 6), 0.061)
    assert monitor.joints.velocities[0] == pytest.approx(math.radians(2) / 0.04)


def test_a_refused_frame_names_the_joint_and_its_range(monitor):
    monitor.note(FaultReported(Fault(FaultCode.OUT_OF_RANGE, 2, 4901)), 0.0)
    expected = 'the board: crank_3: out of range, count 4901 outside [1100, 4900]'
    assert monitor.last_refusal == expected
    monitor.note(FaultReported(Fault(FaultCode.OUT_OF_RANGE, 77, 4901)), 0.0)
    assert 'channel 77' in monitor.last_refusal
    assert monitor.refusals == 2


def test_percentiles_are_milliseconds_under_telling_names():
    report = percentiles_ms('trip', [k / 1000 for k in range(100)])
    assert report == {'trip_p50_ms': 50.0, 'trip_p99_ms': 99.0}


def test_nothing_measured_is_nothing_reported():
    assert Latencies().report('trip') == {}


def test_only_the_newest_count_and_negative_ones_are_zero():
    latencies = Latencies(keep=3)
    for seconds in (9.0, 0.001, -1.0, 0.002):
        latencies.add(seconds)
    assert latencies.report('trip') == {'trip_p50_ms': 1.0, 'trip_p99_ms': 2.0}
