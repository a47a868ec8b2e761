"""Which joint commands move the servos, and what is said of the others.

When a command is refused, test/bridge/test_command_validator.py tries.
"""

import math

import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.graph

NAMES = [f'crank_{i}' for i in range(1, 7)]
PARK = math.radians(120)


def test_commands_move_the_servos_and_silence_holds_them(rig):
    def go():
        rig.go_back_to_disarmed()
        rig.refuses('disarmed', positions=[PARK + 0.05] * 6)
        rig.enable()
        rig.stream(PARK + 0.2)
        rig.wait_for_state('holding')
        assert rig.true_angle() == pytest.approx(PARK + 0.2, abs=0.02)
        rig.stream(PARK + 0.1)
        report = rig.report()
        assert float(report['setpoint_to_frame_p50_ms']) > 0
        assert float(report['round_trip_p50_ms']) > 0
        assert int(report['frames_sent']) > 1

    rig.persist(go)


BAD_COMMANDS = [
    ({'positions': [PARK] * 6, 'names': [*NAMES[:5], 'crank_9']}, "unknown joint 'crank_9'"),
    ({'positions': [PARK] * 5, 'names': NAMES[:5]}, 'no position for crank_6'),
    ({'positions': [PARK] * 6, 'names': ['crank_1'] * 6}, 'crank_1 is named twice'),
    ({'positions': [PARK] * 5 + [math.nan]}, 'crank_6: nan is not finite'),
    ({'positions': [PARK, PARK, 4.0, PARK, PARK, PARK]}, 'crank_3: 4 rad outside'),
    ({'positions': [PARK + 0.5] * 6}, 'crank_1: 2.594 rad would jump by 0.'),
    ({'positions': [], 'names': []}, 'no position for crank_1, crank_2'),
    ({'positions': [PARK] * 10_000, 'names': ['crank_2'] * 10_000}, 'bytes, at most 10000'),
]


def test_a_bad_command_is_named_and_the_next_good_one_works(enabled):
    for command, text in BAD_COMMANDS:
        enabled.persist(lambda c=command, s=text: enabled.refuses(s, **c))
    enabled.stream(PARK + 0.1)


@pytest.mark.parametrize(
    ('bad', 'reason'),
    [
        (serialize_message(JointState(name=['crank_1'] * 100_000)), 'at most 10000'),
        (b'\0\1\0\0\xff', 'no JointState'),
    ],
)
def test_a_joint_command_of_megabytes_or_of_no_sense_is_not_decoded(rig, bad, reason):
    rig.publish_command(bad)
    rig.wait('a refusal', lambda: reason in rig.report()['last_refusal'])
