from dataclasses import replace

import numpy as np
import pytest

from hexarm.machines import load
from manipulator.errors import LimitViolated, Unreachable
from manipulator.setpoint_validator import SetpointValidator

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
AT_HOME = MACHINE.kinematics.inverse(HOME)

ARM = load('arm_6r')


def bent_by(elbow):
    """Joints of the arm; as it stretches, its wrist moves straight away from its shoulder."""
    return np.array([0.1, 0.3 - elbow / 2, elbow, 0.2, 0.9, 0.1])


def raised(z):
    return HOME.moved([0.0, 0.0, z, 0.0, 0.0, 0.0])


@pytest.fixture
def check():
    """One that has just commanded home, where the joints are."""
    made = SetpointValidator(MACHINE)
    made.note_joints(AT_HOME)
    made.admit(HOME, 100.0)
    return made


def test_small_steps_follow_one_another(check):
    for k in range(1, 20):
        joints = check.admit(raised(2e-4 * k), 100.0 + 0.01 * k)
    assert np.abs(MACHINE.kinematics.forward(joints).pose.twist_to(raised(0.0038))).max() < 1e-9


def test_jump_is_refused_names_the_joint_and_changes_nothing(check):
    with pytest.raises(LimitViolated, match=r'crank_\d would jump by .* in 0.02 s'):
        check.admit(raised(0.01), 100.01)
    check.admit(raised(0.0002), 100.02)


def test_what_a_stall_has_bunched_up_is_caught_up_with_once(check):
    steps = [HOME]
    for k in range(1, 13):  # at nine tenths of the joint speed, one a hundredth of a second
        joints = AT_HOME - 0.009 * k * MACHINE.motion.joint.speed
        steps.append(MACHINE.kinematics.forward(joints, steps[-1]).pose)
    with pytest.raises(LimitViolated, match='would jump'):
        check.admit(steps[8], 100.01)
    check.admit(steps[1], 100.08)
    check.admit(steps[8], 100.0801)
    with pytest.raises(LimitViolated, match='would jump'):
        check.admit(steps[12], 100.0802)
    check.admit(steps[9], 100.09)


@pytest.mark.parametrize('tick', [0.01, 0.02])
@pytest.mark.parametrize('part', [0.0, 0.5])
def test_regular_commands_save_nothing_up_for_a_longer_step(check, tick, part):
    speed, joints, pose = MACHINE.motion.joint.speed, AT_HOME, HOME
    for k in range(1, 7):
        joints = joints - part * tick * speed
        pose = MACHINE.kinematics.forward(joints, pose).pose
        check.admit(pose, 100.0 + tick * k)
    leap, step = (MACHINE.kinematics.forward(joints - p * 0.02 * speed).pose for p in (1.5, 0.99))
    with pytest.raises(LimitViolated, match=r'would jump by .* in 0\.02 s'):
        check.admit(leap, 100.0 + tick * 7)
    check.admit(step, 100.0 + tick * 7)


@pytest.mark.parametrize(('gap', 'time'), [(0.005, 0.02), (0.06, 0.06), (0.2, 0.1)])
def test_a_joint_may_step_as_far_as_its_speed_allows_in_a_gap_of_up_to_a_tenth(check, gap, time):
    way = time * MACHINE.motion.joint.speed
    step, leap = (MACHINE.kinematics.forward(AT_HOME - p * way, HOME).pose for p in (0.99, 1.01))
    with pytest.raises(LimitViolated, match=f'would jump by .* in {time:g} s'):
        check.admit(leap, 100.0 + gap)
    check.admit(step, 100.0 + gap)


def test_jump_to_where_the_joints_are_is_no_jump(check):
    check.note_joints(MACHINE.kinematics.inverse(raised(0.01)))
    check.admit(raised(0.01), 100.01)


def test_silence_makes_the_measured_joints_the_start(check):
    check.note_joints(MACHINE.kinematics.inverse(raised(0.01)))
    with pytest.raises(LimitViolated, match='would jump'):
        check.admit(raised(-0.01), 101.0)
    check.admit(raised(0.01), 101.0)


def test_time_left_before_a_silence_does_not_let_a_joint_step_away_from_where_it_is(check):
    check.admit(HOME, 100.2)
    way = 0.05 * MACHINE.motion.joint.speed
    with pytest.raises(LimitViolated, match=r'would jump by .* in 0\.02 s'):
        check.admit(MACHINE.kinematics.forward(AT_HOME - way, HOME).pose, 101.0)
    check.admit(HOME, 101.0)


def test_pose_out_of_reach_or_beyond_a_limit_is_refused_and_the_next_works(check):
    with pytest.raises(Unreachable, match='leg'):
        check.admit(raised(0.2), 100.01)
    with pytest.raises(LimitViolated, match='height'):
        check.admit(raised(-0.02), 100.01)
    check.admit(HOME, 100.02)


def test_machine_beyond_a_limit_may_come_back_but_not_go_on():
    low = raised(-0.0190)
    assert not MACHINE.constraints.admits(low, MACHINE.kinematics.inverse(low))
    check = SetpointValidator(MACHINE)
    check.note_joints(MACHINE.kinematics.inverse(low))
    check.admit(low, 100.0)
    with pytest.raises(LimitViolated):
        check.admit(raised(-0.0191), 100.01)
    check.admit(raised(-0.0189), 100.02)


@pytest.mark.parametrize('tick', [0.01, 0.02])
@pytest.mark.parametrize('step', [0.006, 0.02])
def test_arm_that_is_jogged_through_a_stretched_elbow_goes_on_to_the_other_branch(tick, step):
    check = SetpointValidator(ARM)
    check.note_joints(bent_by(10.3 * step))
    for k in range(20):
        joints = bent_by((10.3 - k) * step)
        admitted = check.admit(ARM.kinematics.forward(joints).pose, 100.0 + tick * k)
        assert np.abs(admitted - joints).max() < 1e-8


@pytest.mark.parametrize('gap', [0.008, 0.05])
def test_arm_whose_next_command_comes_out_of_step_stays_on_its_branch(gap):
    check, pose = SetpointValidator(ARM), ARM.kinematics.forward(bent_by(0.005)).pose
    check.note_joints(bent_by(0.045))
    check.admit(ARM.kinematics.forward(bent_by(0.025)).pose, 100.0)
    check.admit(pose, 100.02)
    assert np.abs(check.admit(pose, 100.02 + gap) - bent_by(0.005)).max() < 1e-8


def test_the_path_from_the_measured_joints_to_the_first_command_is_no_motion_to_go_on_with():
    check, pose = SetpointValidator(ARM), ARM.kinematics.forward(bent_by(0.005)).pose
    check.note_joints(bent_by(0.04))
    check.admit(ARM.kinematics.forward(bent_by(0.04)).pose, 100.0)
    for time in (100.3, 100.5):
        assert np.abs(check.admit(pose, time) - bent_by(0.005)).max() < 1e-8


def test_cranks_turn_back_where_their_legs_are_almost_straight():
    """Up to the edge of the reach and down again, at nine tenths of the joint speed."""
    check, pose = SetpointValidator(MACHINE), HOME
    step = 0.9 * 0.02 * MACHINE.motion.joint.speed
    for k, angle in enumerate([1.035 + step * abs(n) for n in range(-6, 7)]):
        joints = np.full(6, angle)
        pose = MACHINE.kinematics.forward(joints, pose).pose
        if k == 0:
            check.note_joints(joints)
        assert np.abs(check.admit(pose, 100.0 + 0.02 * k) - joints).max() < 1e-6


def test_arm_that_has_come_to_rest_is_commanded_the_very_same_again():
    home, check = ARM.kinematics.home, SetpointValidator(ARM)
    check.note_joints(ARM.kinematics.inverse(home))
    for k in range(20):
        first = check.admit(home.moved([1e-4 * min(k, 10), 0, 0, 0, 0, 0]), 100.0 + 0.01 * k)
    for k in range(20, 30):
        again = check.admit(home.moved([1e-3, 0, 0, 0, 0, 0]), 100.0 + 0.01 * k)
        assert np.array_equal(again, first)


def test_what_the_drives_stay_behind_by_is_commanded_on_top():
    deflection = np.linspace(0.01, 0.02, 6)
    check = SetpointValidator(replace(MACHINE, deflection=lambda pose, joints: deflection))
    np.testing.assert_allclose(
        check.command(HOME, 0.0), MACHINE.kinematics.inverse(HOME) + deflection
    )


def in_line(machine):
    """Joints of an arm whose axes 4 and 6 are in line."""
    joints = machine.kinematics.inverse(machine.kinematics.home)
    joints[4] = 0.0
    return joints


def test_requested_joints_decide_where_a_pose_fixes_none():
    machine = load('arm_6r')
    check, joints = SetpointValidator(machine), in_line(machine)
    check.note_joints(joints)
    for k in range(20):
        joints[3] += 0.002
        check.note_requested(joints.copy(), 0.01 * k)
        found = check.admit(machine.kinematics.forward(joints).pose, 0.01 * k)
        assert np.abs(found - joints).max() < 1e-6


def test_a_setpoint_that_stays_the_same_moves_no_joint_where_a_pose_fixes_none():
    machine = load('arm_6r')
    check, joints = SetpointValidator(machine), in_line(machine)
    check.note_joints(joints)
    for k in range(10):
        joints[3] += 0.002
        check.note_requested(joints.copy(), 0.01 * k)
        pose = machine.kinematics.forward(joints).pose
        check.admit(pose, 0.01 * k)
    for k in range(10, 40):
        found = check.admit(pose, 0.01 * k)
    assert np.abs(found - joints).max() < 1e-6
