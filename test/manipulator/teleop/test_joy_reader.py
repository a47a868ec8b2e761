import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexarm.gamepads import load
from manipulator.teleop.joy_reader import JoyReader

LB, RB, STOP, HOME, FRAME, CLOSE, OPEN = 4, 5, 1, 7, 2, 0, 3
XBOX = load('xbox')
AXES, BUTTONS = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0] * 11


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


def test_trigger_that_reports_zero_before_its_first_touch_does_nothing(gamepad, changed):
    axes = [0.0] * 8
    reader = JoyReader(gamepad).hear(axes, BUTTONS, 1.0)
    assert {'turbo', 'slow'} <= set(reader.untrusted)
    buttons = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    axes[1], axes[5] = 1.0, -1.0
    untouched = reader.hear(axes, buttons, 1.02).wanted(1.02)
    assert untouched.twist[0] == pytest.approx(0.05)


def test_trigger_as_deadman_counts_after_it_was_seen_at_rest(changed):
    trigger = type(XBOX.deadman)(axis=5, rest=1.0, beyond=-0.5)
    reader = changed(deadman=trigger, turbo=None)
    before = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    pulled = [0.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0]
    reader = reader.hear(before, BUTTONS, 1.0).hear(pulled, BUTTONS, 1.02)
    assert not reader.wanted(1.02).is_held
    reader = reader.hear(AXES, BUTTONS, 1.04).hear(pulled, BUTTONS, 1.06)
    assert reader.wanted(1.06).twist[0] == pytest.approx(0.05)


def test_deadman_that_is_pressed_from_the_start_does_not_count(gamepad):
    stuck = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    reader = JoyReader(gamepad).hear(AXES, stuck, 1.0)
    assert not reader.wanted(1.0).is_held
    assert 'deadman' in reader.untrusted


def test_stick_that_never_rests_moves_nothing(gamepad):
    drifting = [0.0, 0.4, *AXES[2:]]
    held = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    reader = JoyReader(gamepad).hear(drifting, BUTTONS, 1.0).hear(drifting, held, 1.02)
    assert reader.wanted(1.02).is_held
    assert not reader.wanted(1.02).twist.any()
    assert reader.untrusted == ('axis 1 (x)',)


@pytest.mark.parametrize(
    ('axes', 'buttons', 'said'),
    [
        ([], [], 'axis 1 (x) is missing: there are 0'),
        (AXES[:4], BUTTONS, 'axis 4 (z) is missing: there are 4'),
        (AXES, BUTTONS[:4], 'button 4 (deadman) is missing: there are 4'),
        ([0.0, math.nan, *AXES[2:]], BUTTONS, 'axis 1 is nan'),
        ([0.0, math.inf, *AXES[2:]], BUTTONS, 'axis 1 is inf'),
        ([0.0, 0.0, 1.2, *AXES[3:]], BUTTONS, 'axis 2 is 1.2, outside [-1.05, 1.05]'),
        (AXES, [0, 0, 7, *BUTTONS[3:]], 'button 2 is 7, needs 0 or 1'),
        ([0.0] * 100, BUTTONS, '100 axes and 11 buttons, at most 64'),
    ],
)
def test_bad_message_releases_the_deadman_and_names_the_index(driver, axes, buttons, said):
    driver.now += 0.02
    driver.reader = driver.reader.hear(axes, buttons, driver.now)
    assert not driver.wanted.is_held
    assert not driver.wanted.twist.any()
    assert said in driver.wanted.reason


def test_good_message_after_a_bad_one_counts(driver):
    driver.reader = driver.reader.hear([], [], driver.now)
    assert driver.send().twist[0] == pytest.approx(0.05)


def test_button_held_through_a_bad_message_is_not_pressed_again(user):
    before = user.press(FRAME).frame
    user.reader = user.reader.hear([], [], user.now)
    assert user.send().frame == before


def test_silence_releases_everything_until_the_deadman_is_pressed_anew(driver):
    assert driver.reader.wanted(driver.now + 0.19).is_held
    lost = driver.reader.wanted(driver.now + 0.21)
    assert not lost.is_held
    assert not lost.twist.any()
    assert 'no message for 0.21 s' in lost.reason
    driver.now += 0.3
    assert not driver.send().is_held
    assert not driver.push(X=0.5).is_held
    driver.axes[1] = 0.0
    driver.release(LB)
    driver.press(LB)
    assert driver.push(X=1.0).twist[0] == pytest.approx(0.05)


def test_pad_that_comes_back_must_show_its_axes_at_rest_again(driver):
    driver.now += 0.3
    driver.release(LB)
    assert driver.press(LB).is_held
    assert not driver.wanted.twist.any()


def test_frozen_pad_with_fresh_messages_stops_the_machine(driver):
    assert driver.hold(0.18).is_held
    frozen = driver.hold(0.06)
    assert not frozen.is_held
    assert not frozen.twist.any()
    assert 'frozen' in frozen.reason


def test_trembling_thumb_drives_on(driver):
    assert driver.hold(10.0, tremor=1 / 32767).twist[0] == pytest.approx(0.05)


def test_first_change_after_a_short_freeze_drives_on(driver):
    driver.hold(1.0)
    assert driver.push(X=0.99).is_held


def test_long_freeze_needs_the_deadman_anew(driver):
    driver.hold(3.1)
    assert not driver.push(X=0.99).is_held
    driver.release(LB)
    assert driver.press(LB).twist.any()


def test_deadman_held_with_sticks_at_rest_is_never_taken_for_frozen(user):
    user.press(LB)
    assert user.hold(10.0).is_held
    assert user.push(X=1.0).twist.any()


def test_modes_cycle_both_ways_once_a_press(user):
    first = user.wanted.mode
    assert user.push(CROSS=-1.0).mode == XBOX.modes[1]
    assert user.send().mode == XBOX.modes[1]
    user.push(CROSS=0.0)
    assert user.push(CROSS=1.0).mode == first
    user.push(CROSS=0.0)
    assert user.push(CROSS=1.0).mode == XBOX.modes[-1]


def test_mode_and_frame_stay_while_driving(driver):
    before = driver.wanted
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
    assert user.reader.wanted(user.now + 0.3).grip == 0


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


def test_home_runs_while_held_and_not_beside_the_deadman(driver):
    homing = driver.press(HOME)
    assert homing.is_homing
    assert not homing.is_held
    assert not driver.reader.wanted(driver.now + 0.3).is_homing
    driver.now += 0.02
    ended = driver.release(HOME)
    assert not ended.is_homing
    assert not ended.is_held


number = st.one_of(
    st.sampled_from([0.0, 1.0, -1.0, math.nan, math.inf, -math.inf, 1.05, 2.0]), st.floats()
)
wild = st.tuples(
    st.lists(number, max_size=10),
    st.lists(st.integers(-1, 2), max_size=13),
    st.floats(0.0, 0.5),
)
tame = st.tuples(
    st.lists(st.sampled_from([0.0, 0.5, 1.0, -1.0]), min_size=8, max_size=8),
    st.lists(st.integers(0, 1), min_size=11, max_size=11),
    st.floats(0.0, 0.3),
)


@settings(max_examples=300)
@given(st.lists(st.one_of(wild, tame), max_size=12), st.floats(0.0, 0.4))
def test_no_stream_of_messages_moves_anything_without_a_deadman_pressed_after_rest(stream, later):
    """Judged from the messages alone: the last one is whole, says pressed and is recent."""
    reader, now = JoyReader(XBOX), 0.0
    was_released = False
    for axes, buttons, pause in stream:
        now += pause
        if pause > XBOX.lost_after:
            was_released = False
        reader = reader.hear(axes, buttons, now)
        is_whole = len(axes) >= 7 and len(buttons) >= 8
        is_whole = is_whole and all(abs(a) <= 1.05 for a in axes)
        is_whole = is_whole and all(b in (0, 1) for b in buttons)
        is_pressed = is_whole and buttons[LB] == 1
        was_released |= is_whole and buttons[LB] == 0
        wanted = reader.wanted(now)
        assert np.isfinite(wanted.twist).all()
        assert not wanted.twist.any() or (is_pressed and was_released)
        assert not wanted.twist.any() or wanted.is_held
    if later > XBOX.lost_after:
        assert not reader.wanted(now + later).twist.any()


@settings(max_examples=200)
@given(st.lists(tame, min_size=1, max_size=12))
def test_twist_never_exceeds_turbo_speed(stream):
    reader, now = JoyReader(XBOX), 0.0
    for axes, buttons, pause in stream:
        now += pause
        reader = reader.hear(axes, buttons, now)
        twist = np.abs(reader.wanted(now).twist)
        assert (twist <= np.array([0.1] * 3 + [1.0] * 3) + 1e-12).all()
