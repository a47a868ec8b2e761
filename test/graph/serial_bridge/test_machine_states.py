"""From one state of the machine to the next: whatever happens, nothing moves by itself."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from manipulator.errors import Refused

pytestmark = pytest.mark.graph

PARK = math.radians(120)


def test_enabling_arms_servo_by_servo_to_park(rig):
    rig.joints.clear()
    rig.enable()
    rig.wait('all joints', lambda: rig.joints and len(rig.joints[-1].name) == 6, 5.0)
    counts = [len(message.name) for message in rig.joints]
    assert counts == sorted(counts)
    assert set(counts) == {1, 2, 3, 4, 5, 6}
    assert rig.joints[-1].position == pytest.approx([PARK] * 6, abs=1e-3)
    assert list(rig.joints[-1].velocity) == [0.0] * 6
    assert len(rig.joints[-1].effort) == 6


def test_disabling_ends_all_pulses(enabled):
    enabled.switch('serial_bridge/enable', False)
    enabled.wait_for_state('disarmed')
    enabled.spin(0.1)
    enabled.joints.clear()
    enabled.spin(0.2)
    assert enabled.joints == []


def test_emergency_stop_latches_until_it_is_cleared(enabled):
    enabled.stop(False)
    enabled.stream(PARK + 0.1)
    assert enabled.machine_state.message == 'enabled'
    enabled.stop()
    enabled.wait_for_state('stopped')
    before = enabled.true_angle()
    enabled.refuses('stopped', positions=[PARK + 0.15] * 6)
    with pytest.raises(Refused, match='clear the stop first'):
        enabled.switch('serial_bridge/enable')
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait_for_state('enabled')
    assert enabled.true_angle() == before
    enabled.stream(PARK)
    assert enabled.true_angle() == pytest.approx(PARK, abs=0.02)


def test_an_unplugged_board_comes_back_disarmed(enabled, port):
    enabled.switch('fake_hardware/plug', False)
    enabled.wait_for_state('disconnected')
    with pytest.raises(Refused, match='no board'):
        enabled.switch('serial_bridge/enable')
    assert not port.exists()
    enabled.switch('fake_hardware/plug')
    enabled.wait_for_state('disarmed')
    before = enabled.true_angle()
    enabled.command([PARK + 0.1] * 6)
    enabled.spin(0.3)
    assert enabled.true_angle() == before
    enabled.enable()


def test_a_mute_board_is_disconnected_and_must_be_enabled_again(enabled):
    enabled.switch('fake_hardware/mute')
    enabled.wait_for_state('disconnected')
    enabled.switch('fake_hardware/mute', False)
    enabled.wait_for_state('unclaimed')
    enabled.refuses('call ~/enable', positions=[PARK] * 6)
    before = enabled.true_angle()
    enabled.enable()
    assert enabled.true_angle() == before


def test_a_reset_ends_disarmed(enabled):
    enabled.stream(PARK + 0.1)
    enabled.trigger('fake_hardware/reset')
    enabled.wait_for_state('disarmed')
    before = enabled.true_angle()
    enabled.command([PARK + 0.1] * 6)
    enabled.spin(0.3)
    assert enabled.true_angle() == before


def test_a_low_battery_is_a_fault_that_must_be_cleared(enabled):
    enabled.set_battery(5.0)
    enabled.wait_for_state('fault')
    with pytest.raises(Refused, match='battery is too low'):
        enabled.trigger('serial_bridge/clear_fault')
    enabled.set_battery(7.6)
    enabled.wait('a good battery', lambda: enabled.report()['battery_v'] == '7.6', 5.0)
    enabled.trigger('serial_bridge/clear_fault')
    enabled.wait_for_state('enabled')


def test_the_state_is_said_again_and_again_for_those_who_must_know_that_the_bridge_lives(rig):
    heard = []
    subscription = rig.node.create_subscription(
        DiagnosticStatus, 'machine_state', lambda m: heard.append(m.message), 10
    )
    rig.wait('the same state four times', lambda: len(heard) >= 4, 10.0)
    rig.node.destroy_subscription(subscription)
    assert set(heard) == {rig.machine_state.message}
