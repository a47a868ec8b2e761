"""Whatever stream of messages a gamepad sends: nothing moves unasked, and nothing too fast."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from hexarm.gamepads import load
from manipulator.teleop.joy_reader import JoyReader
from sampling import enough

LB = 4
XBOX = load('xbox')

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


@settings(max_examples=enough(120, 300))
@given(st.lists(st.one_of(wild, tame), max_size=12), st.floats(0.0, 0.4))
def test_no_stream_of_messages_moves_anything_without_a_deadman_pressed_after_rest(stream, later):
    """Judged from the messages alone: the last one is whole, says pressed and is recent."""
    reader, now = JoyReader(XBOX), 0.0
    was_released = False
    for axes, buttons, pause in stream:
        now += pause
        if pause > XBOX.lost_after:
            was_released = False
        reader = reader.receive(axes, buttons, now)
        is_whole = len(axes) >= 7 and len(buttons) >= 8
        is_whole = is_whole and all(abs(a) <= 1.05 for a in axes)
        is_whole = is_whole and all(b in (0, 1) for b in buttons)
        is_pressed = is_whole and buttons[LB] == 1
        was_released |= is_whole and buttons[LB] == 0
        command = reader.command(now)
        assert np.isfinite(command.twist).all()
        assert not command.twist.any() or (is_pressed and was_released)
        assert not command.twist.any() or command.is_held
    if later > XBOX.lost_after:
        assert not reader.command(now + later).twist.any()


@settings(max_examples=enough(80, 200))
@given(st.lists(tame, min_size=1, max_size=12))
def test_twist_never_exceeds_turbo_speed(stream):
    reader, now = JoyReader(XBOX), 0.0
    for axes, buttons, pause in stream:
        now += pause
        reader = reader.receive(axes, buttons, now)
        twist = np.abs(reader.command(now).twist)
        assert (twist <= np.array([0.1] * 3 + [1.0] * 3) + 1e-12).all()
