"""What the bridge to another driver lets through, and when it is which machine state."""

from dataclasses import replace

import numpy as np
import pytest

from bridge.command_validator import Overtaken
from bridge.topic_driver import TopicDriver
from hexarm.machines import load
from manipulator.errors import InvalidInput, ManipulatorError, Refused

ARM = load('ur5')
NAMES = ARM.kinematics.joint_names
START = np.array([0.3, -1.2, 1.1, -1.5, -1.4, 0.2])
EPOCH = 1.7e9


class Bridged:
    """A driver that stands at START and has reported so at time zero."""

    def __init__(self, machine=ARM, is_simulated=False):
        self.driver = TopicDriver(machine, is_simulated, '/joint_states', EPOCH)
        self.now = 0.0
        self.report(START)

    def report(self, joints):
        if not self.driver.is_simulated:
            self.driver.note_joints(np.asarray(joints, dtype=float), self.now)

    @property
    def state(self):
        return self.driver.status(self.now).state

    def command(self, joints, names=NAMES, stamp=None):
        return self.driver.command(names, list(joints), stamp, self.now)

    def enable(self):
        return self.driver.enable(True, self.now)

    def wait(self, seconds):
        """The driver goes on reporting."""
        for _ in range(round(seconds / 0.1)):
            self.now += 0.1
            self.report(self.driver.joints)


@pytest.fixture
def bridged():
    return Bridged()


def test_nothing_is_sent_before_it_is_enabled_and_everything_that_fits_after(bridged):
    with pytest.raises(Refused, match='disarmed'):
        bridged.command(START)
    bridged.enable()
    assert bridged.state == 'enabled'
    assert not bridged.driver.is_followed
    assert bridged.command(START).tolist() == START.tolist()
    assert bridged.driver.is_followed
    bridged.now += 0.01
    assert bridged.command(START[::-1] + 0.01, NAMES[::-1]) == pytest.approx(START + 0.01)


def test_the_first_command_must_begin_at_the_measured_joints(bridged):
    bridged.enable()
    with pytest.raises(Refused, match=r'joint_2: .* would jump by 0.1 from the reported position'):
        bridged.command(START + 0.1 * np.eye(6)[1])
    bridged.command(START)


def test_a_jump_from_the_last_command_is_refused(bridged):
    bridged.enable()
    bridged.command(START)
    bridged.now += 0.01
    with pytest.raises(Refused, match=r'would jump by .* from the last command'):
        bridged.command(START - 0.5)


def test_a_stop_is_latched_until_it_is_cleared_whatever_comes(bridged):
    bridged.enable()
    bridged.command(START)
    bridged.driver.stop()
    assert bridged.state == 'stopped'
    with pytest.raises(Overtaken, match='stopped'):
        bridged.command(START)
    bridged.wait(0.5)
    with pytest.raises(Refused, match='stopped') as refusal:
        bridged.command(START)
    assert refusal.type is Refused
    with pytest.raises(Refused, match='stopped: until'):
        bridged.enable()
    bridged.driver.clear_fault(bridged.now)
    assert bridged.state == 'enabled'
    assert not bridged.driver.is_followed
    with pytest.raises(Refused, match='would jump'):
        bridged.command(START + 0.1)
    bridged.command(START)


@pytest.mark.parametrize('interruption', ['disabled', 'stopped'])
def test_after_every_interruption_it_begins_where_the_joints_are_by_then(bridged, interruption):
    bridged.enable()
    bridged.command(START)
    assert bridged.driver.is_followed
    if interruption == 'stopped':
        bridged.driver.stop()
    else:
        bridged.driver.enable(False, bridged.now)
    assert bridged.state == ('stopped' if interruption == 'stopped' else 'disarmed')
    assert not bridged.driver.is_followed
    with pytest.raises(Refused):
        bridged.command(START)
    bridged.now += 0.05
    bridged.report(START + 0.3)
    if interruption == 'stopped':
        bridged.driver.clear_fault(bridged.now)
    else:
        bridged.enable()
    with pytest.raises(Refused, match='from the reported position'):
        bridged.command(START)
    bridged.command(START + 0.3)


def test_refusals_are_counted_for_the_diagnostics(bridged):
    assert not bridged.driver.is_followed
    bridged.driver.refuse('one')
    bridged.driver.refuse('two')
    assert (bridged.driver.refusals, bridged.driver.last_refusal) == (2, 'two')


def test_a_stop_before_enabling_counts_too(bridged):
    bridged.driver.stop()
    with pytest.raises(Refused, match='stopped'):
        bridged.enable()
    assert 'cleared' in bridged.driver.clear_fault(bridged.now)
    assert bridged.state == 'disarmed'
    assert 'nothing to clear' in bridged.driver.clear_fault(bridged.now)


def test_it_holds_once_commands_cease_and_goes_on_from_the_measured_joints(bridged):
    bridged.enable()
    bridged.wait(1.9)
    assert bridged.state == 'enabled'
    bridged.command(START)
    bridged.wait(0.3)
    assert bridged.state == 'holding'
    assert not bridged.driver.is_followed
    bridged.report(START + 0.4)
    with pytest.raises(Refused, match='would jump'):
        bridged.command(START)
    bridged.command(START + 0.4)
    assert bridged.state == 'enabled'


@pytest.mark.parametrize('rate', [3.0, 4.6, 4.9, 5.0, 6.0])
def test_a_slow_stream_of_commands_loses_none(bridged, rate):
    bridged.enable()
    for k in range(20):
        bridged.now = k / rate + 0.001 * (k % 3)
        bridged.report(START)
        bridged.command(START, stamp=EPOCH + k / rate)


def test_a_silent_driver_is_disconnected_and_must_be_enabled_again(bridged):
    bridged.enable()
    bridged.command(START)
    bridged.now += 0.6
    assert bridged.state == 'disconnected'
    assert '/joint_states for 0.5 s' in bridged.driver.status(bridged.now).reason
    with pytest.raises(Refused, match='disconnected'):
        bridged.enable()
    bridged.report(START)
    assert bridged.state == 'disarmed'
    with pytest.raises(Refused, match='disarmed'):
        bridged.command(START)


def test_a_driver_of_other_joints_is_not_taken_for_ours():
    driver = TopicDriver(ARM, False, '/joint_states', EPOCH)
    assert 'yet' in driver.status(1.0).reason
    driver.note_others(['finger', *NAMES[:5]])
    assert 'without joint_6' in driver.status(1.0).reason


@pytest.mark.parametrize(
    ('joints', 'names'),
    [
        (START[:5], NAMES[:5]),
        ([*START, 0.0], (*NAMES, 'finger')),
        (START, (*NAMES[:5], NAMES[0])),
        ([np.nan, *START[1:]], NAMES),
        ([7.0, *START[1:]], NAMES),
    ],
)
def test_a_command_that_does_not_fit_is_refused_and_the_next_good_one_is_sent(
    bridged, joints, names
):
    bridged.enable()
    with pytest.raises(InvalidInput):
        bridged.command(joints, names)
    bridged.command(START)


def test_an_old_command_is_refused(bridged):
    bridged.enable()
    bridged.command(START, stamp=EPOCH)
    bridged.now += 0.1
    with pytest.raises(ManipulatorError, match='before the last one'):
        bridged.command(START, stamp=EPOCH - 0.05)


def test_a_simulated_driver_begins_at_home_and_is_where_it_is_commanded():
    bridged = Bridged(is_simulated=True)
    home = ARM.kinematics.rest
    assert bridged.driver.joints == pytest.approx(home)
    bridged.now = 100.0
    assert bridged.state == 'disarmed'
    bridged.enable()
    bridged.command(home + 0.01)
    assert bridged.driver.joints == pytest.approx(home + 0.01)


def test_a_joint_without_end_is_counted_on_where_its_driver_reports_angles_within_a_turn():
    constraints = ARM.kinematics.limits
    high = np.where(np.arange(6) == 5, np.inf, constraints.high)
    limits = replace(constraints, low=-high, high=high)
    machine = replace(ARM, constraints=limits.constraints())
    bridged = Bridged(machine)
    for angle in np.linspace(0.2, 9.0, 100):
        wrapped = (angle + np.pi) % (2 * np.pi) - np.pi
        bridged.report([*START[:5], wrapped])
        assert bridged.driver.joints[5] == pytest.approx(angle)
