"""Only the values change: every comment, space and quote stays."""

import difflib

import pytest
import yaml

from hexarm.machines import shipped
from manipulator.errors import ConfigError
from manipulator.yaml_edit import with_section, with_values

TEXT = """\
# a head
geometry:   # of the machine
  # stays
  radius_mm: 71.5        # goes
  points: [[1, 2],       # goes
           [3, 4]]

  height_mm: 41.0   # goes

# about servos
servos:
  joints:
    - {name: 'a', sign: 1, range: [1.0, 2.0]}   # kept
    - name: "b"
      sign: -1            # here too
"""


def changed_lines(before, after):
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return [line for line in lines if line[0] in '+-']


def test_values_in_flow_and_block_style_change_alone():
    after = with_values(
        TEXT,
        {
            ('servos', 'joints', 0, 'range', 1): '2.25',
            ('servos', 'joints', 0, 'sign'): '-1',
            ('servos', 'joints', 1, 'sign'): '1',
        },
    )
    assert changed_lines(TEXT, after) == [
        "-     - {name: 'a', sign: 1, range: [1.0, 2.0]}   # kept",
        "+     - {name: 'a', sign: -1, range: [1.0, 2.25]}   # kept",
        '-       sign: -1            # here too',
        '+       sign: 1            # here too',
    ]


def test_a_key_that_is_there_again_keeps_its_comment():
    after = with_section(TEXT, 'geometry', ['  height_mm: 42.0', '  radius_mm: 7.0'])
    assert '  height_mm: 42.0   # goes\n  radius_mm: 7.0        # goes\n' in after


@pytest.mark.parametrize('wrong', ['a: [1', 'a: 1\r\n'])
def test_text_that_cannot_be_edited_is_refused(wrong):
    with pytest.raises(ConfigError):
        with_values(wrong, {('a',): '2'})


@pytest.mark.parametrize(
    ('place', 'said'),
    [
        (('servos', 'joints', 2, 'sign'), 'servos.joints.2: missing'),
        (('servos', 'joints'), 'over several lines'),
        (('nothing',), 'nothing: missing'),
    ],
)
def test_a_place_that_is_not_there_is_named(place, said):
    with pytest.raises(ConfigError, match=said):
        with_values(TEXT, {place: '1'})


def test_a_section_is_exchanged_and_what_is_around_it_stays():
    after = with_section(TEXT, 'geometry', ['  width_mm: 3.0'])
    assert after == TEXT.replace(
        TEXT[TEXT.index('  radius') : TEXT.index('\n# about')], '  width_mm: 3.0\n'
    )


@pytest.mark.parametrize('name', sorted(shipped()))
def test_shipped_files_keep_all_but_the_value(name):
    text = shipped()[name].read_text()
    after = with_values(text, {('motion', 'angular_speed_deg_s'): '12.5'})
    assert len([line for line in changed_lines(text, after) if line[0] == '+']) == 1
    wanted = yaml.safe_load(text)
    wanted['motion']['angular_speed_deg_s'] = 12.5
    assert yaml.safe_load(after) == wanted
    exchanged = with_section(text, 'geometry', ['  new: 1'])
    wanted = yaml.safe_load(text) | {'geometry': {'new': 1}}
    assert yaml.safe_load(exchanged) == wanted
