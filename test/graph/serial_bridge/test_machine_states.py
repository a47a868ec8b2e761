"""From one state of the machine to the next, over the line, topics and services.

What each state means for a motion, test/world tries.
"""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from manipulator.errors import Refused

pytestmark = pytest.mark.graph

PARK = math.radians(120)


def test_enabling_arms_servo_by_servo_to_park_and_disabling_ends_all_pulses(rig):
    def go():
        rig.go_back_to_disarmed()
        rig.joints.clear()
        rig.enable()
        rig.wait('all joints', lambda: rig.joints and len(rig.joints[-1].name) == 6)
        counts = [len(message.name) for message in rig.joints]
        assert counts == sorted(counts)
        assert rig.joints[-1].position == pytest.approx([PARK] * 6, abs=1e-3)
        assert list(rig.joints[-1].velocity) == [0.0] * 6
        assert len(rig.joints[-1].effort) == 6
        rig.switch('serial_bridge/enable', False)
        rig.wait_for_state('disarmed')
        rig.spin(0.1)
        rig.joints.clear()
        rig.spin(0.2)
        assert rig.joints == []

    rig.persist(go)


def test_emergency_stop_latches_until_it_is_cleared(enabled):
    moved = []

    def go():
        enabled.stop(False)
        enabled.stream(PARK + 0.1)
        assert enabled.machine_state.message != 'stopped'
        enabled.stop()
        enabled.wait_for_state('stopped')
        before = enabled.true_angle()
        enabled.refuses('stopped', positions=[PARK + 0.15] * 6)
        enabled.stop(False)
        with pytest.raises(Refused, match='clear the stop first'):
            enabled.switch('serial_bridge/enable')
        enabled.trigger('serial_bridge/clear_fault')
        assert enabled.machine_state.message in ('enabled', 'holding')
        moved.append(enabled.true_angle() - before)
        enabled.stream(PARK)

    enabled.persist(go)
    assert set(moved) == {0.0}


def test_an_unplugged_board_comes_back_disarmed(enabled, port):
    enabled.switch('fake_hardware/plug', False)
    enabled.wait_for_state('disconnected')
    with pytest.raises(Refused, match='no board'):
        enabled.switch('serial_bridge/enable')
    enabled.wait('the port to go', lambda: not port.exists())
    enabled.switch('fake_hardware/plug')
    enabled.wait_for_state('disarmed')
    before = enabled.true_angle()
    enabled.refuses('disarmed', positions=[PARK + 0.1] * 6)
    assert enabled.true_angle() == before


def test_every_trouble_that_can_be_asked_of_the_fake_board_shows_in_the_state(enabled):
    def go():
        enabled.switch('fake_hardware/mute')
        enabled.wait_for_state('disconnected')
        enabled.switch('fake_hardware/mute', False)
        enabled.wait_for_state('unclaimed')
        enabled.refuses('call ~/enable', positions=[PARK] * 6)
        enabled.enable()
        enabled.set_battery(5.0)
        try:
            enabled.wait_for_state('fault')
            with pytest.raises(Refused, match='battery is too low'):
                enabled.trigger('serial_bridge/clear_fault')
        finally:
            enabled.set_battery(7.8)
        enabled.wait('a good battery', lambda: enabled.report().get('battery_v') == '7.8')
        enabled.trigger('serial_bridge/clear_fault')
        enabled.switch('fake_hardware/stop_pin')
        enabled.wait_for_state('stopped')
        with pytest.raises(Refused, match='clear'):
            enabled.trigger('serial_bridge/clear_fault')
        enabled.switch('fake_hardware/stop_pin', False)
        enabled.wait('a clear', lambda: enabled.accepts('serial_bridge/clear_fault'))
        enabled.trigger('fake_hardware/reset')
        enabled.wait_for_state('disarmed')
        assert enabled.inject('version').successful
        enabled.wait('the version', lambda: 'the board has protocol 2' in enabled.summary)
        enabled.wait_for_state('disarmed')
        refused = enabled.inject('fire')
        assert not refused.successful
        assert "'fire' is not one of drop, duplicate" in refused.reason

    enabled.persist(go)


def test_the_state_is_reported_again_and_again_for_those_who_must_know_that_the_bridge_lives(rig):
    received = []
    subscription = rig.node.create_subscription(
        DiagnosticStatus, 'machine_state', lambda m: received.append(m.message), 10
    )
    rig.wait('the same state four times', lambda: len(received) > 3 and len({*received[-4:]}) == 1)
    rig.node.destroy_subscription(subscription)
