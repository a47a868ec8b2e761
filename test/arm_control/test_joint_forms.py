"""Machine files of arms that people have: modified DH, names of their own, joints without end."""

from dataclasses import replace

import numpy as np
import pytest

from arm_control.load import arm, jogging, serial_arm
from arm_control.resolved_rate import JogState
from hexarm.machine_check import report_of
from manipulator.errors import ConfigError
from manipulator.pose import Pose
from manipulator.rotation import from_rpy

NAMES = ('left/shoulder_pan_joint', 'lift', 'elbow', 'wrist_1_joint', 'wrist_2_joint', 'flange')


def moved(x=0.0, z=0.0, roll=0.0, yaw=0.0):
    frame = np.eye(4)
    frame[:3, :3] = from_rpy((roll, 0.0, yaw))
    frame[:3, 3] = (x, 0.0, z)
    return frame


def with_joints(file, **changes):
    """The file with something else in every joint; None takes a key away."""
    joints = []
    for i, row in enumerate(file.limits['joints']):
        own = {
            key: value[i] if isinstance(value, tuple) else value for key, value in changes.items()
        }
        joints.append({key: value for key, value in (row | own).items() if value is not None})
    return replace(file, limits={**file.limits, 'joints': joints})


def test_modified_dh_is_the_product_of_its_links(machine_file):
    rng = np.random.default_rng(3)
    rows = [
        dict(zip(('a_mm', 'alpha_deg', 'd_mm', 'offset_deg'), row, strict=True))
        for row in rng.uniform(-1.0, 1.0, (6, 4)) * (300.0, 180.0, 300.0, 180.0)
    ]
    geometry = {'modified_dh': rows, 'home_deg': [0.0] * 6, 'tool_mm': 80.0}
    chain = serial_arm(
        replace(machine_file('puma560'), geometry=geometry, limits=_wide(machine_file))
    ).chain
    for joints in rng.uniform(-np.pi, np.pi, (50, 6)):
        product = np.eye(4)
        for row, q in zip(rows, joints, strict=True):
            product = (
                product @ moved(roll=np.radians(row['alpha_deg'])) @ moved(x=1e-3 * row['a_mm'])
            )
            product = (
                product
                @ moved(yaw=q + np.radians(row['offset_deg']))
                @ moved(z=1e-3 * row['d_mm'])
            )
        product = product @ moved(z=0.08)
        pose = chain.forward(joints)
        assert np.abs(pose.position - product[:3, 3]).max() < 1e-12
        assert np.abs(pose.rotation - product[:3, :3]).max() < 1e-12


def _wide(machine_file):
    return with_joints(machine_file('puma560'), range_deg=[-360.0, 360.0]).limits


def test_standard_and_modified_tables_of_one_arm_agree(machine_file):
    file = machine_file('puma560')
    standard = file.geometry['dh']
    before = [{'a_mm': 0.0, 'alpha_deg': 0.0}, *standard[:5]]
    rows = [
        {'a_mm': b['a_mm'], 'alpha_deg': b['alpha_deg'], 'd_mm': row['d_mm']}
        for b, row in zip(before, standard, strict=True)
    ]
    geometry = {'modified_dh': rows, 'home_deg': file.geometry['home_deg']}
    modified = serial_arm(replace(file, geometry=geometry))
    usual = serial_arm(file)
    assert modified.is_explicit
    for joints in np.random.default_rng(4).uniform(-1.5, 1.5, (20, 6)):
        assert modified.chain.forward(joints).position == pytest.approx(
            usual.chain.forward(joints).position, abs=1e-12
        )


def test_names_of_their_own_are_in_joints_limits_jogs_and_drawings(machine_file):
    file = with_joints(machine_file('ur5'), name=NAMES)
    machine = arm(file)
    kinematics = machine.kinematics
    assert kinematics.joint_names == NAMES
    with pytest.raises(Exception, match=r'wrist_1_joint: joint angle 8.727 rad') as caught:
        machine.constraints.check(kinematics.home, np.radians([0.0, 0.0, 0.0, 500.0, 0.0, 0.0]))
    assert caught.value.leg == 4
    (stroke,) = kinematics.skeleton(kinematics.home, kinematics.rest)
    assert stroke.owners == ('', *NAMES, '')
    jog = jogging(file)
    fast = jog.step(JogState(kinematics.rest, np.zeros(6)), np.array([9.0, 0, 0, 0, 0, 0]), 0.01)
    assert fast.held_by.rpartition(' of ')[2] in NAMES


@pytest.mark.parametrize('name', ['', 'a joint', 'x' * 65, 'a\nb'])
def test_a_name_that_no_message_can_carry_is_refused(machine_file, name):
    with pytest.raises(ConfigError, match=r'joints\[0\]: name: .* needs 1 to 64 letters'):
        arm(with_joints(machine_file('ur5'), name=(name, *NAMES[1:])))


def test_two_joints_of_one_name_are_refused(machine_file):
    with pytest.raises(ConfigError, match='duplicate names'):
        arm(with_joints(machine_file('ur5'), name=(NAMES[1], *NAMES[1:])))


@pytest.mark.parametrize('name', ['ur5', 'puma560'])
def test_continuous_joints_turn_without_end_and_every_pose_is_solved(machine_file, name):
    machine = arm(with_joints(machine_file(name), range_deg=None, continuous=True))
    kinematics, rng = machine.kinematics, np.random.default_rng(5)
    assert np.isinf(machine.joint_ranges).all()
    for joints in rng.uniform(-40.0, 40.0, (50, 6)):
        pose = kinematics.forward(joints).pose
        assert kinematics.inverse(pose, joints) == pytest.approx(joints, abs=1e-6)
        assert bool(machine.constraints.admits(pose, joints))


def test_continuous_joints_of_an_arm_without_a_closed_form_are_solved(machine_file):
    file = with_joints(machine_file('puma560'), range_deg=None, continuous=True)
    rows = [dict(row) for row in file.geometry['dh']]
    rows[4]['a_mm'] = 10.0
    kinematics = arm(replace(file, geometry={**file.geometry, 'dh': rows})).kinematics
    assert not kinematics.is_explicit
    joints = np.array([0.3, 0.5, -2.0, 0.4, 0.8, 0.2])
    pose = kinematics.forward(joints).pose
    found = kinematics.inverse_all(pose)
    assert np.nanmin(np.abs(found - joints).max(axis=1)) < 1e-6


def test_a_jog_carries_a_continuous_joint_through_whole_turns(machine_file):
    jog = jogging(with_joints(machine_file('ur5'), range_deg=None, continuous=True))
    state = JogState(jog.arm.rest, np.zeros(6))
    turning = jog.arm.home.rotation[:, 2]
    for _ in range(1000):
        step = jog.step(state, np.concatenate([np.zeros(3), 1.5 * turning]), 0.01)
        state = step.state
    assert abs(state.joints[5] - jog.arm.rest[5]) > 2 * np.pi
    assert state.joints[:5] == pytest.approx(jog.arm.rest[:5], abs=1e-6)


def test_ranges_of_many_turns_are_kept(machine_file):
    file = with_joints(machine_file('ur5'), range_deg=[-10_000.0, 7200.0])
    kinematics = arm(file).kinematics
    joints = kinematics.rest + 2 * np.pi * np.array([-27, 19, -20, 12, 5, -6])
    pose = kinematics.forward(joints).pose
    assert kinematics.inverse(pose, joints) == pytest.approx(joints, abs=1e-9)


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'range_deg': None}, 'range_deg: missing .*continuous: true'),
        ({'continuous': True}, 'range_deg: a continuous joint has none'),
    ],
)
def test_a_joint_has_a_range_or_says_that_it_has_none(machine_file, changes, said):
    with pytest.raises(ConfigError, match=said):
        arm(with_joints(machine_file('ur5'), **changes))


@pytest.mark.parametrize('count', [5, 7])
def test_five_or_seven_axes_are_refused_in_one_sentence(machine_file, count):
    file = machine_file('ur5')
    dh = (file.geometry['dh'] * 2)[:count]
    joints = (file.limits['joints'] * 2)[:count]
    with pytest.raises(ConfigError) as caught:
        arm(
            replace(
                file,
                geometry={**file.geometry, 'dh': dh},
                limits={**file.limits, 'joints': joints},
            )
        )
    (problem,) = caught.value.problems
    assert (
        problem == f'geometry.dh: has {count} axes, arms with 6 are supported; 5 and 7 are planned'
    )


def test_check_compares_servos_with_joints_of_other_names(machine_file):
    file = with_joints(machine_file('ur5'), name=NAMES)
    content = {key: value for key, value in vars(file).items() if key not in ('motion', 'frames')}
    report = report_of(content | {'motion': vars(file.motion)})
    assert any("none is called 'elbow'" in problem for problem in report.problems)


def test_a_pose_far_off_is_refused_by_an_arm_of_continuous_joints(machine_file):
    kinematics = arm(with_joints(machine_file('ur5'), range_deg=None, continuous=True)).kinematics
    far = Pose(np.array([9.0, 0.0, 0.0]), np.eye(3))
    assert np.isnan(kinematics.inverse_or_nan(far)).all()
