"""The deadman: who has the joystick, and what ends a press."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hexarm.panel.joystick import Beat, Joystick
from manipulator.deadlines import RELEASE

UP = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
STEP = 0.033


def beat(press, tick=None, stick=UP):
    return Beat(press, tick, stick)


def held(joystick, page=1, press=0, now=0.0):
    """A press of two beats, so that a tick has come back; returns the time."""
    joystick.receive(page, beat(press), now)
    joystick.receive(page, beat(press, tick=now), now + STEP)
    return now + STEP


def test_nothing_moves_before_a_tick_came_back():
    joystick = Joystick()
    joystick.receive(1, beat(0), 0.0)
    assert joystick.stick(0.0) is None
    joystick.receive(1, beat(0, tick=0.0), STEP)
    assert joystick.stick(STEP) is UP
    assert joystick.holder(STEP) == 1


def test_release_stops_at_once():
    joystick = Joystick()
    now = held(joystick)
    joystick.release(1, 0)
    assert joystick.stick(now) is None
    assert joystick.reason(1) == ''


def test_a_page_that_is_gone_stops_at_once():
    joystick = Joystick()
    now = held(joystick)
    joystick.leave(1)
    assert joystick.stick(now) is None


def test_silence_ends_the_press():
    joystick = Joystick()
    now = held(joystick)
    assert joystick.stick(now + RELEASE) is UP
    assert joystick.stick(now + RELEASE + 1e-3) is None
    assert 'press again' in joystick.reason(1)


def test_beats_after_a_silence_move_nothing_until_a_new_press():
    joystick = Joystick()
    now = held(joystick) + 1.0
    for _ in range(20):
        joystick.receive(1, beat(0, tick=now), now + STEP)
        now += STEP
        assert joystick.stick(now) is None
    now = held(joystick, press=1, now=now)
    assert joystick.stick(now) is UP


def test_beats_that_queued_up_on_the_line_end_the_press():
    joystick = Joystick()
    now = held(joystick)
    joystick.receive(1, beat(0, tick=now - RELEASE - 0.01), now + 0.01)
    assert joystick.stick(now + 0.01) is None


@pytest.mark.parametrize('tick', [1e9, 0.5])
def test_a_tick_from_the_future_or_of_another_press_ends_the_press(tick):
    joystick = Joystick()
    now = held(joystick)
    joystick.receive(1, beat(0, tick=tick), now + STEP)
    assert joystick.stick(now + STEP) is None


def test_the_first_page_has_it_and_the_second_must_press_anew():
    joystick = Joystick()
    now = held(joystick, page=1)
    joystick.receive(2, beat(0, stick=-UP), now)
    joystick.receive(2, beat(0, tick=now, stick=-UP), now)
    assert joystick.stick(now) is UP
    assert 'another page' in joystick.reason(2)
    joystick.release(1, 0)
    joystick.receive(2, beat(0, tick=now, stick=-UP), now + STEP)
    assert joystick.stick(now + STEP) is None
    now = held(joystick, page=2, press=1, now=now + STEP)
    assert joystick.holder(now) == 2


def test_a_stop_takes_it_from_the_holder_until_a_new_press():
    joystick = Joystick()
    now = held(joystick)
    joystick.stop()
    joystick.receive(1, beat(0, tick=now), now + STEP)
    assert joystick.stick(now + STEP) is None
    assert 'stopped' in joystick.reason(1)
    assert joystick.stick(held(joystick, press=1, now=now + STEP)) is UP


EVENTS = st.lists(
    st.tuples(
        st.sampled_from(['beat', 'release', 'leave', 'stop']),
        st.integers(0, 2),
        st.integers(0, 3),
        st.one_of(st.none(), st.floats(0.0, 0.5)),
        st.floats(0.0, 0.4),
    ),
    max_size=60,
)


@given(EVENTS)
def test_whatever_comes_it_moves_only_on_a_fresh_beat_of_the_holder(events):
    joystick, now, received = Joystick(), 0.0, {}
    for kind, page, press, age, pause in events:
        now += pause
        if kind == 'beat':
            joystick.receive(page, beat(press, None if age is None else now - age), now)
            received[page] = now, age
        elif kind == 'release':
            joystick.release(page, press)
        elif kind == 'leave':
            joystick.leave(page)
            received.pop(page, None)
        else:
            joystick.stop()
        if joystick.stick(now) is not None:
            at, delay = received[joystick.holder(now)]
            assert now - at <= RELEASE
            assert delay is not None
            assert delay <= RELEASE + 1e-9
