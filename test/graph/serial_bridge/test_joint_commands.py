"""Which joint commands move the servos, and what is said of the others."""

import math

import pytest
from sensor_msgs.msg import JointState

from manipulator.nodes.qos import COMMAND

pytestmark = pytest.mark.graph

NAMES = [f'crank_{i}' for i in range(1, 7)]
PARK = math.radians(120)


def test_unknown_joints_are_not_published_and_commands_move_nothing(rig):
    rig.joints.clear()
    before = rig.true_angle()
    rig.refuses('disarmed', positions=[PARK + 0.05] * 6)
    assert rig.joints == []
    assert rig.true_angle() == before


def test_commands_move_the_servos_and_silence_holds_them(enabled):
    enabled.stream(PARK + 0.2)
    enabled.wait_for_state('holding')
    assert enabled.true_angle() == pytest.approx(PARK + 0.2, abs=0.02)
    enabled.stream(PARK + 0.1)
    assert enabled.machine_state.message == 'enabled'
    report = enabled.report()
    assert float(report['setpoint_to_frame_p50_ms']) > 0
    assert float(report['round_trip_p50_ms']) > 0
    assert int(report['frames_sent']) >= 50


BAD_COMMANDS = [
    ({'positions': [PARK] * 6, 'names': [*NAMES[:5], 'crank_9']}, "unknown joint 'crank_9'"),
    ({'positions': [PARK] * 5, 'names': NAMES[:5]}, 'no position for crank_6'),
    ({'positions': [PARK] * 6, 'names': ['crank_1'] * 6}, 'crank_1 stands twice'),
    ({'positions': [PARK] * 5 + [math.nan]}, 'crank_6: nan is not finite'),
    ({'positions': [PARK, PARK, 4.0, PARK, PARK, PARK]}, 'crank_3: 4 rad outside'),
    ({'positions': [PARK + 0.5] * 6}, 'crank_1: 2.594 rad would jump by 0.45'),
    ({'positions': [], 'names': []}, 'no position for crank_1, crank_2'),
    ({'positions': [PARK] * 10_000, 'names': ['crank_2'] * 10_000}, 'bytes, at most 10000'),
]


def test_a_bad_command_is_named_and_the_next_good_one_works(enabled):
    enabled.stream(PARK + 0.05, 0.2)
    for command, said in BAD_COMMANDS:
        enabled.refuses(said, **command)
        enabled.stream(PARK + 0.05, 0.1)
        assert enabled.machine_state.message == 'enabled', said
    enabled.stream(PARK + 0.1)
    assert enabled.true_angle() == pytest.approx(PARK + 0.1, abs=0.02)


def test_a_sender_with_another_clock_is_followed_and_reported(enabled):
    for k in range(20):
        enabled.command([PARK + 0.005 * k] * 6, clock=3600.0)
        enabled.spin(0.02)
    report = enabled.report()
    assert float(report['joint_command_clock_offset_s']) == pytest.approx(-3600, abs=2)
    assert enabled.true_angle() == pytest.approx(PARK + 0.095, abs=0.02)


def test_a_second_publisher_of_commands_is_said(rig):
    other = rig.node.create_publisher(JointState, 'joint_command', COMMAND)
    crowd = '2 publishers on joint_command'
    rig.wait('the complaint', lambda: crowd in rig.report()['message'], 10.0)
    rig.node.destroy_publisher(other)
    rig.wait('peace', lambda: crowd not in rig.report()['message'], 10.0)
