from itertools import pairwise

import pytest

from manipulator.errors import InvalidInput
from manipulator.teleop.pad import ABS, BEATS, KEY, Axis, Pad, is_gamepad

XBOX_AXES = {code: Axis(0, -32768, 32767) for code in (0, 1, 3, 4)} | {
    2: Axis(0, 0, 255),
    5: Axis(0, 0, 255),
    0x10: Axis(0, -1, 1),
    0x11: Axis(0, -1, 1),
}
XBOX_KEYS = dict.fromkeys(
    [0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x13A, 0x13B, 0x13C, 0x13D, 0x13E], False
)
KEYBOARD_KEYS = dict.fromkeys(range(1, 100), False)


@pytest.fixture
def pad():
    return Pad.from_device(XBOX_AXES, XBOX_KEYS, has_heartbeat=False)


def test_untouched_pad_has_sticks_at_zero_and_triggers_at_plus_one(pad):
    axes, buttons = pad.joy
    assert axes == pytest.approx([0, 0, 1, 0, 0, 1, 0, 0], abs=1e-4)
    assert buttons == [0] * 11


@pytest.mark.parametrize(
    ('code', 'value', 'index', 'joy'),
    [
        (0, -32768, 0, 1.0),
        (1, -32768, 1, 1.0),
        (1, 32767, 1, -1.0),
        (5, 255, 5, -1.0),
        (0x10, -1, 6, 1.0),
        (0x11, -1, 7, 1.0),
    ],
)
def test_left_up_and_rest_are_plus_one(pad, code, value, index, joy):
    axes, _ = pad.after(ABS, code, value).joy
    assert axes[index] == pytest.approx(joy)


def test_left_bumper_is_the_mapping_s_deadman(pad):
    _, buttons = pad.after(KEY, 0x136, 1).joy
    assert buttons.index(1) == 4
    assert pad.after(KEY, 0x136, 1).after(KEY, 0x136, 0).joy == pad.joy


def test_events_and_codes_of_other_things_are_ignored(pad):
    assert pad.after(ABS, 0x28, 5).after(KEY, 30, 1).after(4, 4, 9) == pad
    wide = Pad.from_device(XBOX_AXES | {0x28: Axis(0, 0, 9)}, XBOX_KEYS | {172: False}, False)
    assert wide == pad


def test_value_beyond_the_range_that_the_kernel_reports_is_full(pad):
    assert pad.after(ABS, 0, -40000).joy[0][0] == 1.0


def test_heartbeat_changes_with_every_report_and_stays_in_range():
    pad = Pad.from_device(XBOX_AXES, XBOX_KEYS, has_heartbeat=True)
    seen = []
    for _ in range(2 * BEATS):
        pad = pad.beaten()
        seen.append(pad.joy[0][8])
    assert all(a != b for a, b in pairwise(seen))
    assert 0.0 <= min(seen) <= max(seen) < 1.0


def test_pad_without_sensors_has_no_heartbeat(pad):
    assert pad.beaten() == pad


def test_mouse_keyboard_and_sensors_are_no_gamepads():
    assert is_gamepad(XBOX_AXES, XBOX_KEYS)
    assert not is_gamepad({}, KEYBOARD_KEYS)
    assert not is_gamepad({0: Axis(0, 0, 9)}, {0x110: False})
    assert not is_gamepad(XBOX_AXES, {})


def test_empty_axis_range_is_refused():
    with pytest.raises(InvalidInput, match='empty'):
        Axis(0, 5, 5)
