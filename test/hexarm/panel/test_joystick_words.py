"""What a page may say to the joystick, and what is turned away."""

import contextlib
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hexarm.panel.page_requests import answer, beat_of
from manipulator.errors import InvalidInput

STICK = [0.0, 0.5, -1.0, 0.0, 0.0, 0.0]


def test_a_beat_and_a_release():
    beat = beat_of(json.dumps({'press': 3, 'tick': 1.5, 'stick': STICK}))
    assert (beat.press, beat.tick, beat.stick.tolist()) == (3, 1.5, STICK)
    assert beat_of('{"press": 3, "released": true}') == 3
    assert beat_of(json.dumps({'press': 0, 'tick': None, 'stick': STICK})).tick is None


def test_a_stick_beyond_its_end_is_at_its_end():
    beat = beat_of(json.dumps({'press': 0, 'tick': None, 'stick': [9.0, -9.0, 0, 0, 0, 0]}))
    assert beat.stick.tolist() == [1.0, -1.0, 0.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    'text',
    [
        '',
        '[]',
        '{}',
        b'{"press": 1, "released": true}',
        '{"press": true, "released": true}',
        '{"press": -1, "released": true}',
        '{"press": 1}',
        '{"press": 1, "stick": [0, 0, 0, 0, 0]}',
        '{"press": 1, "stick": [0, 0, 0, 0, 0, NaN]}',
        '{"press": 1, "stick": [0, 0, 0, 0, 0, "1"]}',
        '{"press": 1, "tick": Infinity, "stick": [0, 0, 0, 0, 0, 0]}',
        '{"press": 1, "stick": [0, 0, 0, 0, 0, 0], "more": "' + 1000 * 'x' + '"}',
        '[' * 999,
    ],
)
def test_anything_else_is_refused(text):
    with pytest.raises(InvalidInput):
        beat_of(text)


WORDS = st.sampled_from(['press', 'tick', 'stick'])
LEAVES = st.none() | st.booleans() | st.floats() | st.text()
JSON = st.recursive(LEAVES, lambda inner: st.lists(inner) | st.dictionaries(WORDS, inner))


@given(st.text(max_size=200) | JSON.map(json.dumps))
def test_no_words_do_harm(text):
    with contextlib.suppress(InvalidInput):
        beat_of(text)


def test_the_answer_is_what_the_page_reads():
    assert json.loads(answer(1.5, True, False, '')) == {
        'tick': 1.5,
        'has_it': True,
        'is_taken': False,
        'reason': '',
    }
