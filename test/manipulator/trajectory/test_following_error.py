import numpy as np

from manipulator.trajectory.following_error import FollowingError, Tolerances

DT = 0.01
NAMES = ('a', 'b')
TOLERANCES = Tolerances(np.full(2, 0.1), np.full(2, 0.01), 1e-3, 1e-3, np.zeros(2))


def following():
    return FollowingError(NAMES, 'rad', TOLERANCES, DT)


def drive(judge, commands, measured):
    """The first tick at which there is violation, and the violation."""
    for k, (command, joints) in enumerate(zip(commands, measured, strict=True)):
        judge.command(np.array(command))
        judge.measure(np.array(joints))
        if judge.violation:
            return k, judge.violation
    return None, ''


def test_joints_that_lag_by_less_than_half_a_second_follow():
    commands = [(0.01 * k, 0.0) for k in range(200)]
    measured = [(0.01 * max(k - 40, 0), 0.0) for k in range(200)]
    assert drive(following(), commands, measured) == (None, '')


def test_stuck_joint_is_named_within_a_second():
    commands = [(0.0, 0.01 * k) for k in range(200)]
    tick, violation = drive(following(), commands, [(0.0, 0.0)] * 200)
    assert tick < 100
    assert violation.startswith('b is')


def test_short_excursion_is_no_violation():
    measured = [(0.3 * (50 < k < 70), 0.0) for k in range(200)]
    assert drive(following(), [(0.0, 0.0)] * 200, measured) == (None, '')


def test_joints_may_be_elsewhere_for_three_tenths_of_a_second_and_no_longer():
    judge = following()
    judge.command(np.zeros(2))
    judge.measure(np.array([0.3, 0.0]))
    for _ in range(30):
        judge.command(np.zeros(2))
        assert not judge.violation
    judge.command(np.zeros(2))
    assert judge.violation


def test_measurements_that_stop_coming_keep_the_last_word():
    judge = following()
    judge.command(np.zeros(2))
    judge.measure(np.array([0.3, 0.0]))
    for _ in range(100):
        judge.command(np.zeros(2))
    assert judge.violation
