import numpy as np
import pytest

from hexarm.machines import load
from manipulator.command_check import CommandCheck
from manipulator.errors import LimitViolated, Unreachable

MACHINE = load('robocake')
HOME = MACHINE.kinematics.home
AT_HOME = MACHINE.kinematics.inverse(HOME)


def raised(z):
    return HOME.moved([0.0, 0.0, z, 0.0, 0.0, 0.0])


@pytest.fixture
def check():
    """One that has just commanded home, where the joints are."""
    made = CommandCheck(MACHINE)
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


def test_jump_to_where_the_joints_are_is_no_jump(check):
    check.note_joints(MACHINE.kinematics.inverse(raised(0.01)))
    check.admit(raised(0.01), 100.01)


def test_silence_makes_the_measured_joints_the_start(check):
    check.note_joints(MACHINE.kinematics.inverse(raised(0.01)))
    with pytest.raises(LimitViolated, match='would jump'):
        check.admit(raised(-0.01), 101.0)
    check.admit(raised(0.01), 101.0)


def test_pose_out_of_reach_or_beyond_a_limit_is_refused_and_the_next_works(check):
    with pytest.raises(Unreachable, match='leg'):
        check.admit(raised(0.2), 100.01)
    with pytest.raises(LimitViolated, match='height'):
        check.admit(raised(-0.02), 100.01)
    check.admit(HOME, 100.02)


def test_machine_beyond_a_limit_may_come_back_but_not_go_on():
    low = raised(-0.0190)
    assert not MACHINE.constraints.admits(low, MACHINE.kinematics.inverse(low))
    check = CommandCheck(MACHINE)
    check.note_joints(MACHINE.kinematics.inverse(low))
    check.admit(low, 100.0)
    with pytest.raises(LimitViolated):
        check.admit(raised(-0.0191), 100.01)
    check.admit(raised(-0.0189), 100.02)


def test_arm_that_has_come_to_rest_is_commanded_the_very_same_again():
    arm = load('arm_6r')
    home, check = arm.kinematics.home, CommandCheck(arm)
    check.note_joints(arm.kinematics.inverse(home))
    for k in range(20):
        first = check.admit(home.moved([1e-4 * min(k, 10), 0, 0, 0, 0, 0]), 100.0 + 0.01 * k)
    for k in range(20, 30):
        again = check.admit(home.moved([1e-3, 0, 0, 0, 0, 0]), 100.0 + 0.01 * k)
        assert np.array_equal(again, first)
