from dataclasses import replace

import pytest

from arm_control.inverse_method import Numerical
from arm_control.joint_limits import ArmLimits
from arm_control.load import arm, jogging, serial_arm
from arm_control.parallel_axes import ParallelAxes
from arm_control.spherical_wrist import SphericalWrist
from bridge.servo_config import BoardConfig
from manipulator.config import build
from manipulator.errors import ConfigError


@pytest.mark.parametrize(
    ('name', 'method'),
    [('arm_6r', SphericalWrist), ('puma560', SphericalWrist), ('ur5', ParallelAxes)],
)
def test_shipped_arms_have_closed_forms(machine_file, name, method):
    machine = arm(machine_file(name))
    assert isinstance(machine.kinematics.method, method)
    home = machine.kinematics.home
    machine.constraints.check(home, machine.kinematics.inverse(home))


@pytest.mark.parametrize('name', ['arm_6r', 'puma560', 'ur5'])
def test_park_is_home_and_within_the_pulses(machine_file, name):
    file = machine_file(name)
    servos = BoardConfig.from_machine(file).servos
    assert [joint.name for joint in servos.joints[:6]] == list(arm(file).kinematics.joint_names)
    assert list(servos.park_deg[:6]) == file.geometry['home_deg']
    for joint, (low, high), park in zip(
        servos.joints,
        [row['range_deg'] for row in file.limits['joints']],
        servos.park_deg,
        strict=False,
    ):
        for angle in (low, high, park):
            pulse = joint.centre_us + joint.sign * joint.us_per_deg * (angle - joint.centre_deg)
            assert joint.pulse_range_us[0] <= pulse <= joint.pulse_range_us[1]


def test_an_arm_with_a_skew_wrist_is_solved_numerically(machine_file):
    file = machine_file('puma560')
    rows = [dict(row) for row in file.geometry['dh']]
    rows[4]['a_mm'] = 10.0
    skew = replace(file, geometry={**file.geometry, 'dh': rows})
    assert isinstance(serial_arm(skew).method, Numerical)


def test_another_kind_of_machine_is_refused(machine_file):
    with pytest.raises(ConfigError, match='kind'):
        arm(replace(machine_file('arm_6r'), kind='rotary_hexapod'))


def test_a_geometry_of_no_form_or_two_is_refused(machine_file):
    file = machine_file('arm_6r')
    dh = machine_file('ur5').geometry['dh']
    for geometry in ({'home_deg': [0.0] * 6}, {**file.geometry, 'dh': dh}):
        with pytest.raises(ConfigError, match='needs one of the keys'):
            arm(replace(file, geometry=geometry))


def test_every_fault_of_the_limits_is_named(machine_file):
    file = machine_file('arm_6r')
    joints = [dict(row) for row in file.limits['joints']]
    joints[1]['range_deg'] = [10.0, -10.0]
    joints[2]['sped_deg_s'] = joints[2].pop('speed_deg_s')
    with pytest.raises(ConfigError) as caught:
        jogging(replace(file, limits={**file.limits, 'joints': joints}))
    assert 'joints[1]' in str(caught.value)
    assert "did you mean 'speed_deg_s'" in str(caught.value)


ENDS = {
    'range_deg': (-720.0, 720.0),
    'speed_deg_s': (0.1, 5000.0),
    'acceleration_deg_s2': (1.0, 1e6),
    'characteristic_length_mm': (1.0, 5000.0),
    'damping_onset': (0.001, 0.5),
}


@pytest.mark.parametrize('key', ENDS)
def test_limits_may_be_as_low_and_as_high_as_this_and_no_further(machine_file, key):
    file, (low, high) = machine_file('arm_6r'), ENDS[key]

    def limits(value):
        if key not in file.limits['joints'][0]:
            return build(ArmLimits, {**file.limits, key: value})
        first, *others = file.limits['joints']
        value = [min(value, 0.0), max(value, 0.0)] if key == 'range_deg' else value
        return build(ArmLimits, {**file.limits, 'joints': [{**first, key: value}, *others]})

    beyond = 1e-6 * (high - low)
    for end, outside in ((low, low - beyond), (high, high + beyond)):
        limits(end)
        with pytest.raises(ConfigError, match=rf'{key}.*: \S+ outside \['):
            limits(outside)


def test_a_home_outside_the_joint_ranges_is_refused(machine_file):
    file = machine_file('arm_6r')
    geometry = {**file.geometry, 'home_deg': [0.0, 20.0, 80.0, 0.0, 130.0, 0.0]}
    with pytest.raises(ConfigError, match=r'home_deg\[4\]: 130 outside \[-120, 120\]'):
        arm(replace(file, geometry=geometry))


def test_a_screw_without_direction_is_refused(machine_file):
    screws = [{'axis': [0.0, 0.0, 0.0], 'point_mm': [0.0, 0.0, 0.0]}] * 6
    geometry = {
        'screws': screws,
        'tool_position_mm': [0.0, 0.0, 0.0],
        'tool_rpy_deg': [0.0, 0.0, 0.0],
        'home_deg': [0.0] * 6,
    }
    with pytest.raises(ConfigError, match='has no direction'):
        arm(replace(machine_file('arm_6r'), geometry=geometry))
