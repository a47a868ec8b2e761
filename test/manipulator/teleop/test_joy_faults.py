"""A gamepad that lies, falls silent or freezes moves nothing, and what it told wrong is said."""

import math

import pytest

from hexarm.gamepads import load
from manipulator.teleop.joy_reader import JoyReader

LB, FRAME = 4, 2
XBOX = load('xbox')
AXES, BUTTONS = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0] * 11


def test_trigger_that_reports_zero_before_its_first_touch_does_nothing(gamepad):
    axes = [0.0] * 8
    reader = JoyReader(gamepad).receive(axes, BUTTONS, 1.0)
    assert {'turbo', 'slow'} <= set(reader.untrusted)
    buttons = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    axes[1], axes[5] = 1.0, -1.0
    untouched = reader.receive(axes, buttons, 1.02).command(1.02)
    assert untouched.twist[0] == pytest.approx(0.05)


def test_trigger_as_deadman_counts_after_it_was_seen_at_rest(changed):
    trigger = type(XBOX.deadman)(axis=5, rest=1.0, beyond=-0.5)
    reader = changed(deadman=trigger, turbo=None)
    before = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    pulled = [0.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0]
    reader = reader.receive(before, BUTTONS, 1.0).receive(pulled, BUTTONS, 1.02)
    assert not reader.command(1.02).is_held
    reader = reader.receive(AXES, BUTTONS, 1.04).receive(pulled, BUTTONS, 1.06)
    assert reader.command(1.06).twist[0] == pytest.approx(0.05)


def test_deadman_that_is_pressed_from_the_start_does_not_count(gamepad):
    stuck = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    reader = JoyReader(gamepad).receive(AXES, stuck, 1.0)
    assert not reader.command(1.0).is_held
    assert 'deadman' in reader.untrusted


def test_stick_that_never_rests_moves_nothing(gamepad):
    drifting = [0.0, 0.4, *AXES[2:]]
    held = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    reader = JoyReader(gamepad).receive(drifting, BUTTONS, 1.0).receive(drifting, held, 1.02)
    assert reader.command(1.02).is_held
    assert not reader.command(1.02).twist.any()
    assert reader.untrusted == ('axis 1 (x)',)


@pytest.mark.parametrize(
    ('axes', 'buttons', 'text'),
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
def test_bad_message_releases_the_deadman_and_names_the_index(driver, axes, buttons, text):
    driver.now += 0.02
    driver.reader = driver.reader.receive(axes, buttons, driver.now)
    assert not driver.command.is_held
    assert not driver.command.twist.any()
    assert text in driver.command.reason


def test_good_message_after_a_bad_one_counts(driver):
    driver.reader = driver.reader.receive([], [], driver.now)
    assert driver.send().twist[0] == pytest.approx(0.05)


def test_button_held_through_a_bad_message_is_not_pressed_again(user):
    before = user.press(FRAME).frame
    user.reader = user.reader.receive([], [], user.now)
    assert user.send().frame == before


def test_silence_releases_everything_until_the_deadman_is_pressed_anew(driver):
    assert driver.reader.command(driver.now + 0.19).is_held
    lost = driver.reader.command(driver.now + 0.21)
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
    assert not driver.command.twist.any()


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


CROWD = 'more than one publisher sends on /arm/joy'
HELD = [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
PUSHED = [0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]


def interleaved(reader, begin, buttons=HELD):
    """A frozen pad's messages between those of one that rests; all that was command."""
    command = []
    for k in range(100):
        now = begin + 0.01 * k
        crowd = (AXES, BUTTONS) if k % 2 else (PUSHED, buttons)
        reader = reader.receive(*crowd, now, CROWD)
        command.append(reader.command(now))
    return reader, command


def test_frozen_pad_beside_one_that_rests_moves_nothing_and_reports_why(gamepad):
    _, command = interleaved(JoyReader(gamepad).receive(AXES, BUTTONS, 1.0), 1.01)
    assert not any(w.is_held or w.twist.any() or w.is_homing or w.grip for w in command)
    assert {w.reason for w in command} == {CROWD}


def test_buttons_of_a_frozen_pad_change_neither_mode_nor_frame(gamepad):
    start = JoyReader(gamepad).receive(AXES, BUTTONS, 1.0)
    all_but_stop = [int(k != 1) for k in range(11)]
    reader, _ = interleaved(start, 1.01, all_but_stop)
    assert (reader.mode, reader.frame, reader.stops) == (start.mode, start.frame, 0)


def test_stop_button_works_while_two_pads_send(gamepad):
    pressed = [int(k == 1) for k in range(11)]
    reader, _ = interleaved(JoyReader(gamepad).receive(AXES, BUTTONS, 1.0), 1.01, pressed)
    assert reader.stops > 0


def test_pad_that_is_left_alone_must_be_released_before_it_drives(gamepad):
    reader, _ = interleaved(JoyReader(gamepad).receive(AXES, BUTTONS, 1.0), 1.01)
    for k in range(50):
        reader = reader.receive(PUSHED, HELD, 2.01 + 0.02 * k)
        assert not reader.command(2.01 + 0.02 * k).is_held
    reader = reader.receive(AXES, BUTTONS, 3.01).receive(PUSHED, HELD, 3.03)
    assert reader.command(3.03).twist[0] == pytest.approx(0.05)
