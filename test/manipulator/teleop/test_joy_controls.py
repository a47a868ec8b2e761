"""What the sticks and buttons of a sound gamepad do."""

import pytest

from hexarm.gamepads import load

LB, RB, STOP, HOME, FRAME, CLOSE, OPEN, SAVE = 4, 5, 1, 7, 2, 0, 3, 6
XBOX = load('xbox')


def test_stick_moves_its_component_only_under_the_deadman(user):
    assert not user.push(X=1.0).twist.any()
    assert user.press(LB).twist.tolist() == [0.05, 0, 0, 0, 0, 0]
    assert user.push(X=0.0, YAW=-1.0).twist.tolist() == [0, 0, 0, 0, 0, -0.5]
    released = user.release(LB)
    assert not released.is_held
    assert not released.twist.any()


def test_shift_turns_the_right_stick_into_tilts(user):
    user.press(LB, RB)
    assert user.push(Z=1.0, YAW=1.0).twist.tolist() == [0, 0, 0, -0.5, 0.5, 0]


def test_slow_wins_over_turbo(driver):
    assert driver.push(TURBO=-1.0).twist[0] == pytest.approx(0.1)
    assert driver.push(SLOW=-1.0).twist[0] == pytest.approx(0.01)
    assert driver.push(TURBO=1.0, SLOW=1.0).twist[0] == pytest.approx(0.05)


def test_modes_cycle_both_ways_once_a_press(user):
    first = user.command.mode
    assert user.push(CROSS=-1.0).mode == XBOX.modes[1]
    assert user.send().mode == XBOX.modes[1]
    user.push(CROSS=0.0)
    assert user.push(CROSS=1.0).mode == first
    user.push(CROSS=0.0)
    assert user.push(CROSS=1.0).mode == XBOX.modes[-1]


def test_mode_and_frame_stay_while_driving(driver):
    before = driver.command
    driver.push(CROSS=-1.0)
    after = driver.press(FRAME)
    assert (after.mode, after.frame) == (before.mode, before.frame)


def test_frame_button_goes_round(user):
    assert user.press(FRAME).frame == 'tool'
    user.release(FRAME)
    assert user.press(FRAME).frame == 'base'


def test_gripper_moves_only_under_the_deadman(user):
    assert user.press(CLOSE).grip == 0
    assert user.press(LB).grip == -1
    user.release(CLOSE)
    assert user.press(OPEN).grip == 1
    assert user.reader.command(user.now + 0.3).grip == 0


def test_stop_takes_the_deadman_away_until_it_is_pressed_anew(driver):
    stopped = driver.press(STOP)
    assert stopped.stops == 1
    assert not stopped.is_held
    assert driver.send().stops == 1
    assert not driver.release(STOP).is_held
    driver.release(LB)
    assert driver.press(LB).is_held


def test_stop_counts_without_the_deadman(user):
    assert user.press(STOP).stops == 1


def test_a_pose_is_saved_once_a_press_and_not_while_driving(user):
    assert user.press(SAVE).saves == 1
    assert user.send().saves == 1
    user.release(SAVE)
    user.press(LB)
    user.push(X=1.0)
    assert user.press(SAVE).saves == 1


def test_home_runs_while_held_and_not_beside_the_deadman(driver):
    homing = driver.press(HOME)
    assert homing.is_homing
    assert not homing.is_held
    assert not driver.reader.command(driver.now + 0.3).is_homing
    driver.now += 0.02
    ended = driver.release(HOME)
    assert not ended.is_homing
    assert not ended.is_held
