import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bridge.calibration import Calibration, OutOfRange
from bridge.servo_config import BoardConfig, ServoConfig, ServosConfig
from hexarm import machines
from manipulator.config import build
from manipulator.errors import ConfigError, InvalidInput

ROBOCAKE = BoardConfig.from_machine(machines.read('robocake'))


@pytest.fixture
def robocake():
    return Calibration.from_config(ROBOCAKE.servos)


def servo(name='lift', channel=0, **changes):
    values = {
        'name': name,
        'channel': channel,
        'sign': 1,
        'centre_us': 1500.0,
        'centre_deg': 0.0,
        'us_per_deg': 10.0,
        'pulse_range_us': [500.0, 2500.0],
    }
    return {key: value for key, value in (values | changes).items() if value is not None}


MILLIMETRES = {'centre_deg': None, 'us_per_deg': None, 'centre_mm': 150.0, 'us_per_mm': 10.0}


def servos(*joints, **changes):
    values = {'speed_deg_s': 600.0, 'park_deg': [0.0] * len(joints), 'joints': list(joints)}
    return build(ServosConfig, {key: v for key, v in (values | changes).items() if v is not None})


def test_a_count_is_half_a_microsecond_and_sign_mirrors():
    calibration = Calibration.from_config(servos(servo('a'), servo('b', 1, sign=-1)))
    ten_degrees = math.radians(10)
    assert calibration.counts([ten_degrees, ten_degrees]) == (2 * 1600, 2 * 1400)


def test_counts_stand_in_channel_order_and_positions_in_file_order():
    calibration = Calibration.from_config(servos(servo('a', 2), servo('b', 0), servo('c', 1)))
    degrees = np.radians([10.0, 20.0, 30.0])
    assert calibration.counts(degrees) == (3400, 3600, 3200)
    assert np.allclose(calibration.positions((3400, 3600, 3200)), degrees)


def test_linear_joints_are_metres():
    joints = [servo(**MILLIMETRES)]
    config = servos(*joints, park_deg=None, park_mm=[150.0], speed_deg_s=None, speed_mm_s=20.0)
    calibration = Calibration.from_config(config)
    assert calibration.counts([0.151]) == (2 * 1510,)
    assert calibration.unit == 'm'
    assert calibration.speed == pytest.approx(0.02)
    assert calibration.count_speeds == pytest.approx((400.0,))
    with pytest.raises(OutOfRange, match=r'lift: 0\.3 m outside \[0\.05, 0\.25\]'):
        calibration.counts([0.3])


@given(st.lists(st.floats(0.53, 3.65), min_size=6, max_size=6))
def test_positions_come_back_to_half_a_count(positions):
    calibration = Calibration.from_config(ROBOCAKE.servos)
    back = calibration.positions(calibration.counts(positions))
    half_count = 0.5 / (2 * 10.5) * math.radians(1)
    assert np.all(np.abs(back - positions) <= half_count * (1 + 1e-9))


def test_out_of_range_names_joint_value_and_range(robocake):
    wanted = robocake.park.copy()
    wanted[2] = 3.92
    with pytest.raises(OutOfRange, match=r'crank_3: 3\.92 rad outside \[0\.5153, 3\.674\]') as e:
        robocake.counts(wanted)
    assert e.value.joint == 'crank_3'


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_a_position_that_is_not_finite_is_named(robocake, value):
    wanted = robocake.park.copy()
    wanted[4] = value
    with pytest.raises(InvalidInput, match=r'crank_5: .* is not finite'):
        robocake.counts(wanted)


def test_ends_of_the_range_can_be_reached(robocake):
    for i in range(6):
        for end in robocake.range_of(i):
            wanted = robocake.park.copy()
            wanted[i] = end
            assert robocake.counts(wanted)[i] in (1100, 4900)


@pytest.mark.parametrize(('sign', 'low', 'high'), [(1, -60.0, 140.0), (-1, -120.0, 80.0)])
def test_a_servo_whose_centre_is_not_the_middle_has_its_range_on_the_right_side(sign, low, high):
    joint = servo(sign=sign, centre_us=1200.0, centre_deg=10.0, pulse_range_us=[500.0, 2500.0])
    calibration = Calibration.from_config(servos(joint))
    assert np.degrees(calibration.range_of(0)) == pytest.approx((low, high))
    for end, beyond in ((low, low - 0.1), (high, high + 0.1)):
        calibration.counts([math.radians(end)])
        with pytest.raises(OutOfRange, match='lift'):
            calibration.counts([math.radians(beyond)])


def test_one_count_beyond_the_range_is_refused(robocake):
    count = 1 / 21 * math.radians(1)
    for i in range(6):
        for end, step in zip(robocake.range_of(i), (-count, count), strict=True):
            wanted = robocake.park.copy()
            wanted[i] = end + step
            with pytest.raises(OutOfRange, match=robocake.names[i]):
                robocake.counts(wanted)


def test_wrong_number_of_positions_is_refused(robocake):
    with pytest.raises(InvalidInput, match='5 positions, needs 6'):
        robocake.counts([2.0] * 5)


def test_a_park_pose_out_of_reach_is_a_config_error():
    with pytest.raises(ConfigError, match=r'servos\.park: lift: 2\.443 rad outside'):
        Calibration.from_config(servos(servo(), park_deg=[140.0]))


@pytest.mark.parametrize(
    ('joints', 'changes', 'problem'),
    [
        ([servo(sign=0)], {}, 'sign: 0 is neither 1 nor -1'),
        ([servo(centre_us=3000.0)], {}, r'centre_us: 3000 outside \[500, 2500\]'),
        ([servo(us_per_deg=None)], {}, 'needs centre_deg and us_per_deg'),
        ([servo(centre_mm=1.0, us_per_mm=1.0)], {}, 'needs centre_deg and us_per_deg'),
        ([servo('a'), servo('a', 1)], {}, 'duplicate names'),
        (
            [servo('a', is_gripper=True), servo('b', 1, is_gripper=True)],
            {},
            'joints: more than one is the gripper',
        ),
        (
            [servo('a'), servo('b', 1, **MILLIMETRES)],
            {},
            'joints: some are in degrees, others in millimetres',
        ),
        ([servo('a'), servo('b', 2)], {}, r'channels \[0, 2\] are not 0 to 1'),
        ([servo()], {'park_deg': [0.0, 0.0]}, 'park_deg: 2 values for 1 joint$'),
        ([servo()], {'park_deg': None}, 'park_deg: missing'),
        ([servo()], {'speed_deg_s': None}, 'speed_deg_s: missing'),
        ([servo(centre_us=1.5)], {}, r'centre_us: 1.5 outside \[100, 30000\]'),
        ([{**servo(), 'us_per_degree': 3.0}], {}, "unknown key, did you mean 'us_per_deg'"),
        ([], {}, '0 joints, 1 to 18 fit'),
    ],
)
def test_what_is_wrong_with_the_servos_is_reported(joints, changes, problem):
    with pytest.raises(ConfigError, match=problem):
        servos(*joints, **changes)


def test_a_machine_files_sections_are_checked_at_once():
    machine = machines.read('robocake')
    broken = dataclasses.replace(
        machine,
        link={**machine.link, 'on_link_loss': 'relase'},
        simulation={'hysteresis': 0.5},
    )
    with pytest.raises(ConfigError) as caught:
        BoardConfig.from_machine(broken)
    assert "link.on_link_loss: 'relase' is not one of hold, release" in str(caught.value)
    assert 'simulation.hysteresis: unknown key' in str(caught.value)


def test_every_shipped_machine_with_a_board_has_servos_that_fit_its_limits():
    for path in machines.shipped().values():
        if machines.read(str(path)).driver == 'topic':
            continue
        config = BoardConfig.from_machine(machines.read(str(path)), str(path))
        assert isinstance(config.servos.joints[0], ServoConfig)
        Calibration.from_config(config.servos)
