"""What the bridge admits, answers and announces: in simulated time, with a fake board."""

import dataclasses
from contextlib import nullcontext

import numpy as np
import pytest

from bridge.command_validator import Overtaken
from bridge.driver import BoardDriver
from bridge.fake.board_thread import FakeMachine
from bridge.framing import FrameReader
from bridge.protocol import Arm, Clear, Setpoint, Stop
from bridge.servo_config import BoardConfig
from hexarm import machines
from manipulator.errors import InvalidInput, Refused

EPOCH = 1.7e9
STEP = 0.005


class Rig:
    """A driver of a board, and all that it announces; `is_mute`: the board answers nothing."""

    def __init__(self, name='robocake'):
        config = BoardConfig.from_machine(machines.read(name))
        servos = dataclasses.replace(config.servos, arm_interval_ms=20)
        config = dataclasses.replace(config, servos=servos)
        self.board = FakeMachine.from_config(config, boot_s=0.1, hysteresis=0.0).board
        self.now = 100.0
        self.joints, self.states, self.troubles, self.written, self.frames = [], [], [], [], []
        self.is_mute = False
        self._reader = FrameReader()
        self.driver = BoardDriver(config, self, EPOCH)
        self.park = self.driver.calibration.park
        self.names = self.driver.calibration.names
        self.driver.link.opened(self.now)

    def on_joints(self, joints):
        self.joints.append(joints)

    def on_machine_state(self, state):
        self.states.append(state)

    def on_problem(self, text):
        self.troubles.append(text)

    def on_written(self, ticket, now):
        self.written.append(ticket)

    def run(self, seconds):
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self.board.step(STEP)
            received = self.board.take_output()
            output = self.driver.link.turn(b'' if self.is_mute else received, self.now)
            self.frames += [frame.message for frame in self._reader.feed(output)]
            self.board.feed(b'' if self.is_mute else output)
            self.driver.link.written(b'', self.now)

    def answered(self, asked):
        self.run(0.1)
        return self.driver.answer(asked)

    def enable(self):
        self.run(0.3)
        assert self.answered(self.driver.enable(True))[0]
        self.run(1.0)
        assert self.state.status.state == 'enabled'

    def command(self, positions, names=None):
        stamp = EPOCH + self.now
        self.driver.command(names or self.names, list(positions), stamp, self.now)
        self.run(0.02)

    def sent(self, kind):
        return [message for message in self.frames if isinstance(message, kind)]

    @property
    def state(self):
        return self.states[-1]


@pytest.fixture
def rig():
    return Rig()


@pytest.fixture
def enabled(rig):
    rig.enable()
    return rig


def test_a_command_becomes_a_frame_and_the_machine_is_followed(enabled):
    assert not enabled.state.is_followed
    enabled.command(enabled.park)
    assert enabled.sent(Setpoint)[-1].counts == enabled.driver.calibration.counts(enabled.park)
    assert enabled.state.is_followed
    assert [ticket.received for ticket in enabled.written] == [pytest.approx(enabled.now - 0.02)]


def test_a_machine_that_was_stopped_is_followed_again_with_the_next_frame(enabled):
    enabled.command(enabled.park)
    enabled.answered(enabled.driver.stop())
    enabled.answered(enabled.driver.clear_fault())
    assert (enabled.state.status.state, enabled.state.is_followed) == ('enabled', False)
    enabled.command(enabled.park)
    assert enabled.state.is_followed


@pytest.mark.parametrize('turn', [0.5, -0.5])
def test_a_jump_is_refused_and_nothing_is_sent(enabled, turn):
    enabled.command(enabled.park)
    with pytest.raises(Refused, match='would jump'):
        enabled.command(enabled.park + turn)
    enabled.run(0.1)
    assert len(enabled.sent(Setpoint)) == 1


def test_a_bridge_that_stood_still_follows_nothing_before_it_has_read_the_state_of_the_board(
    enabled,
):
    enabled.command(enabled.park)
    enabled.now += 0.3
    with pytest.raises(Refused, match='not known at present'):
        enabled.command(enabled.park)
    enabled.run(0.3)
    enabled.command(enabled.park)
    enabled.run(0.02)
    assert len(enabled.sent(Setpoint)) == 2


def test_a_command_of_before_the_board_was_found_to_hold_moves_nothing(enabled):
    enabled.command(enabled.park)
    enabled.run(0.3)
    assert enabled.state.status.state == 'holding'
    found = enabled.driver.monitor.holding_since
    for lead, is_refused in ((0.01, True), (-0.01, False)):
        stamp = EPOCH + found - lead
        with pytest.raises(Refused, match='known to hold') if is_refused else nullcontext():
            enabled.driver.command(enabled.names, list(enabled.park), stamp, enabled.now)
    enabled.run(0.1)
    assert enabled.state.status.state == 'enabled'
    assert enabled.driver.monitor.holding_since == float('-inf')


def test_what_is_not_enabled_reports_why_it_takes_no_command(rig):
    rig.run(0.3)
    with pytest.raises(Refused, match=r'^disarmed$'):
        rig.command(rig.park)
    rig.enable()
    rig.command(rig.park)
    rig.run(0.3)
    assert rig.state.status.state == 'holding'
    rig.driver.stop()
    rig.run(0.1)
    with pytest.raises(Refused, match=r'^stopped \(until ~/clear_fault is called\)$'):
        rig.command(rig.park)


def test_a_command_while_a_stop_is_in_progress_reports_that(enabled):
    enabled.driver.session.is_stop_requested = True
    with pytest.raises(Refused, match=r'^a STOP is in progress$'):
        enabled.command(enabled.park)


def test_what_a_stop_overtakes_is_told_from_what_is_sent_after_it(enabled):
    rig = enabled
    rig.command(rig.park)
    rig.driver.stop()
    with pytest.raises(Overtaken, match=r'^a STOP is in progress$'):
        rig.command(rig.park)
    rig.run(0.1)
    with pytest.raises(Overtaken, match=r'^stopped '):
        rig.command(rig.park)
    rig.run(0.2)
    with pytest.raises(Refused) as refusal:
        rig.command(rig.park)
    assert refusal.type is Refused


def test_from_the_moment_a_stop_is_asked_for_no_command_is_admitted(enabled):
    enabled.driver.stop()
    with pytest.raises(Refused):
        enabled.command(enabled.park)
    enabled.run(0.1)
    assert enabled.sent(Setpoint | Stop) == [Stop()]


@pytest.mark.parametrize('restart', ['enable', 'clear_fault'])
def test_after_an_answer_the_next_command_must_start_where_the_joints_are(enabled, restart):
    rig = enabled
    far = rig.park + 0.06  # a step within a pulse period, no start
    rig.command(rig.park)
    if restart == 'enable':
        rig.driver.enable(False)
        rig.run(0.02)
        rig.driver.enable(True)
    else:
        rig.driver.stop()
        rig.run(0.02)
        rig.driver.clear_fault()
    while not rig.driver.session.accepts_setpoints:
        rig.run(STEP)
    with pytest.raises(Refused, match='the reported position'):
        rig.command(far)


def test_without_an_answer_between_the_next_command_starts_at_the_last(enabled):
    enabled.command(enabled.park)
    enabled.command(enabled.park + 0.06)
    assert len(enabled.sent(Setpoint)) == 2


def test_services_answer_when_the_board_has_obeyed(rig):
    rig.run(0.3)
    assert rig.answered(rig.driver.enable(True)) == (
        True,
        'arming: the servos go to park one by one',
    )
    assert rig.answered(rig.driver.stop()) == (True, 'stopped: ~/clear_fault ends it')
    assert rig.answered(rig.driver.enable(True)) == (
        False,
        'the board is stopped: clear the stop first',
    )
    assert rig.answered(rig.driver.clear_fault()) == (
        True,
        'cleared: nothing moves until a new command',
    )
    assert rig.answered(rig.driver.enable(False)) == (True, 'disarmed: no more pulses')


def test_servos_that_are_on_already_do_not_go_to_park(enabled):
    enabled.command(enabled.park)
    enabled.run(0.3)
    assert enabled.state.status.state == 'holding'
    said = 'enabled: the servos are on already, nothing moves'
    assert enabled.answered(enabled.driver.enable(True)) == (True, said)


def test_what_is_so_already_is_not_asked_of_a_machine_that_may_be_moving(enabled):
    enabled.frames.clear()
    assert enabled.driver.answer(enabled.driver.enable(True)) == (True, 'enabled already')
    nothing = 'nothing to clear: the machine is enabled'
    assert enabled.driver.answer(enabled.driver.clear_fault()) == (True, nothing)
    enabled.run(0.1)
    assert enabled.sent(Arm | Clear) == []


def test_a_refusal_is_reported_with_what_is_wrong_with_the_board(rig):
    rig.driver.link.lost('/dev/ttyACM0 was disconnected', rig.now)
    asked = rig.driver.enable(True)
    rig.run(STEP)
    reason = 'no board is connected: no port: /dev/ttyACM0 was disconnected'
    assert rig.driver.answer(asked) == (False, reason)


@pytest.mark.parametrize('is_mute', [True, False])
def test_every_question_is_answered_within_a_second(enabled, is_mute):
    enabled.is_mute = is_mute
    asked = [enabled.driver.enable(False)]
    enabled.run(0.02)
    asked += [enabled.driver.clear_fault(), enabled.driver.stop(), enabled.driver.stop()]
    enabled.run(0.9)
    assert all(question.future.done() for question in asked)
    assert [enabled.driver.answer(question)[0] for question in asked] == [
        not is_mute,
        True,  # there is nothing to clear
        not is_mute,
        not is_mute,
    ]


def test_a_gripper_stays_until_it_is_asked_and_forgets_that_with_the_enable():
    rig = Rig('arm_6r')
    rig.enable()
    names, positions = list(rig.names[:6]), rig.park[:6]
    rig.command(positions, names)
    at_park = rig.driver.calibration.counts(rig.park)
    assert rig.sent(Setpoint)[-1].counts == at_park
    rig.driver.aim_gripper(1.0)
    for _ in range(5):
        rig.command(positions, names)
    opened = rig.sent(Setpoint)[-1].counts
    assert opened[:6] == at_park[:6]
    assert opened[6] != at_park[6]
    rig.answered(rig.driver.enable(False))
    with pytest.raises(Refused, match='disarmed'):
        rig.driver.aim_gripper(0.0)
    rig.enable()
    for _ in range(5):
        rig.command(positions, names)
    assert rig.sent(Setpoint)[-1].counts == at_park


def test_a_machine_without_a_gripper_reports_that(enabled):
    with pytest.raises(InvalidInput, match='no gripper'):
        enabled.driver.aim_gripper(0.5)


def test_joints_are_announced_once_any_is_known(rig):
    rig.run(0.3)
    assert rig.joints == []
    assert rig.state.unknown_joints == rig.names
    rig.enable()
    assert np.allclose(rig.joints[-1].positions, rig.park, atol=1e-3)
    assert rig.state.unknown_joints == ()


def test_what_goes_wrong_is_announced_in_words(enabled):
    enabled.is_mute = True
    enabled.driver.enable(False)
    enabled.run(0.6)
    assert enabled.troubles[0] == 'DISARM: no answer from the board after 4 tries'
    assert 'no frame' in enabled.troubles[1]
    assert enabled.state.status.state == 'disconnected'
