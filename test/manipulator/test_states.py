"""The states that travel as words are those that docs/interfaces.md lists."""

import re
from pathlib import Path

import pytest

from manipulator.states import MachineState, MotionMode, MotionResult

TEXT = (Path(__file__).parents[2] / 'docs/interfaces.md').read_text()


def listed(pattern):
    return re.search(pattern, TEXT)[1].split(', ')


@pytest.mark.parametrize(
    ('kind', 'pattern'),
    [
        (MachineState, r'message is one of ([a-z, ]+);'),
        (MotionMode, r'`mode` \(([a-z, ]+)\)'),
        (MotionResult, r'`result` \(([a-z, ]+);'),
    ],
)
def test_the_words_are_those_of_the_interface(kind, pattern):
    assert [str(word) for word in kind] == listed(pattern)


def test_a_state_is_its_word_wherever_it_is_written():
    state = MachineState.ENABLED
    assert f'the machine is {state}' == 'the machine is enabled'
    assert state == 'enabled'
    assert {'enabled': 1}[state] == 1
