from dataclasses import replace

import numpy as np
import pytest

from arm_control.closed_forms import ParallelAxes, SphericalWrist
from arm_control.joint_limits import ArmLimits
from arm_control.load import arm, jogging, serial_arm
from arm_control.numerical import Numerical
from bridge.servo_config import BoardConfig
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.rotation import from_rpy


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
    neither, both = {'home_deg': [0.0] * 6}, {**file.geometry, 'dh': dh}
    for geometry, said in (
        (neither, r'one of L1_mm, dh, modified_dh, screws'),
        (both, 'dh: does not go with L1_mm'),
    ):
        with pytest.raises(ConfigError, match=said):
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
    'range_deg': (-360_000.0, 360_000.0),
    'speed_deg_s': (1e-6, 1e9),
    'acceleration_deg_s2': (1e-6, 1e9),
    'characteristic_length_mm': (1e-3, 1e6),
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

    for end, outside in ((low, low - 1e-6 * abs(low)), (high, high + 1e-6 * high)):
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


CALIBRATED = (
    (0.279332356195598, 89.97377351635724, 88.8794492754001, -0.0005515862795130782),
    (-56.6854832098269, -0.04204899604596786, 574241.3845794561, -82.33806877859622),
    (-326.46702272051, 0.1865592729591728, -507363.40209816804, 116.04865943980298),
    (0.0149388687216263, 89.9772951184475, -66767.6839353205, -33.70451094100497),
    (0.000223692592990586, -90.01224276111223, 94.9734691141216, 0.0023700249666705636),
    (0.0, 0.0, 82.56250145549531, 0.0004683211769942338),
)
"""A UR5's own parameters, Universal_Robots_ROS_Driver issue 457: axes 2 to 4 almost parallel."""

KEYS = ('a_mm', 'alpha_deg', 'd_mm', 'offset_deg')


def with_rows(file, rows):
    dh = [dict(zip(KEYS, row, strict=True)) for row in rows]
    return replace(file, geometry={**file.geometry, 'dh': dh})


def test_calibrated_arm_whose_distances_along_axes_cancel_is_taken_whole(machine_file):
    calibrated = arm(with_rows(machine_file('ur5'), CALIBRATED)).kinematics
    nominal = arm(machine_file('ur5')).kinematics
    joints = np.array([0.3, -1.2, 1.1, -1.5, -1.4, 0.2])
    pose = calibrated.forward(joints).pose
    product = np.eye(4)
    for (a, alpha, d, offset), q in zip(CALIBRATED, joints, strict=True):
        turned, tilted, moved = np.eye(4), np.eye(4), np.eye(4)
        turned[:3, :3] = from_rpy((0.0, 0.0, q + np.radians(offset)))
        tilted[:3, :3] = from_rpy((np.radians(alpha), 0.0, 0.0))
        moved[:3, 3] = 1e-3 * a, 0.0, 1e-3 * d
        product = product @ turned @ moved @ tilted
    assert pose.position == pytest.approx(product[:3, 3], abs=1e-9)
    assert pose.rotation == pytest.approx(product[:3, :3], abs=1e-9)
    assert np.linalg.norm(pose.position - nominal.forward(joints).pose.position) < 5e-3
    found = calibrated.inverse_all(pose)
    assert np.nanmin(np.abs(found - joints).max(axis=1)) < 1e-9
    as_built, ideal = (np.isfinite(k.inverse_all(pose)).all(axis=1) for k in (calibrated, nominal))
    assert as_built.sum() == ideal.sum()
    (stroke,) = calibrated.skeleton(pose, joints)
    assert np.abs(stroke.points).max() < 1.0


@pytest.mark.parametrize(
    ('change', 'said'),
    [
        (
            lambda i, a, d: (1e-3 * a, 1e-3 * d),
            'all links together are 1.*, 20 mm to 200 m fit',
        ),
        (
            lambda i, a, d: (a, 1e3 * d if i == 0 else d),
            'joint 2 is 89.16 m from joint 1, the next link is 425 mm',
        ),
        (lambda i, a, d: (a, 133e3 if i == 1 else d), 'joint 5 is 133.1 m from joint 4'),
        (
            lambda i, a, d: (1e3 * a, d),
            'all links together are 81.* m, 20 mm to 200 m fit',
        ),
    ],
)
def test_arm_out_of_proportion_is_asked_about_its_units(machine_file, change, said):
    file = machine_file('ur5')
    rows = [[row.get(key, 0.0) for key in KEYS] for row in file.geometry['dh']]
    for i, row in enumerate(rows):
        row[0], row[2] = change(i, row[0], row[2])
    with pytest.raises(ConfigError, match=said):
        arm(with_rows(file, rows))
