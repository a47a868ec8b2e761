from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import pytest

from manipulator import strict_yaml
from manipulator.config import build, build_both, parse_yaml, quantity
from manipulator.errors import ConfigError

CONFIG = Path(__file__).parents[2] / 'config'


@dataclass(frozen=True)
class Servo:
    name: str
    sign: Literal[-1, 1]
    centre_us: float = quantity(500, 2500)


@dataclass(frozen=True)
class Machine:
    rod_length_mm: float = quantity(1, 2000)
    range_deg: tuple[float, float] = quantity(-360, 360)
    servos: tuple[Servo, ...] = ()
    label: str | None = None


GOOD = """
rod_length_mm: 58
range_deg: [30, 210]
servos:
  - {name: a, sign: 1, centre_us: 1500}
"""


def problems(text):
    with pytest.raises(ConfigError) as error:
        build(Machine, parse_yaml(text))
    return error.value.problems


def test_a_mistake_of_syntax_is_shown_in_its_line():
    assert problems('a: 1\n b: 2')[0] == "line 2: mapping values are not allowed here: 'b: 2'"
    assert problems('a: 1\nc:\n\tb: 2')[0] == (
        "line 3 begins with a tab, YAML needs spaces there: 'b: 2'"
    )


@pytest.mark.parametrize('path', sorted(CONFIG.glob('*.yaml')), ids=lambda path: path.stem)
def test_files_hold_the_same_with_libyaml_and_without(path, monkeypatch):
    found = parse_yaml(path.read_text())
    monkeypatch.setattr(strict_yaml, 'QuickLoader', strict_yaml.StrictLoader)
    assert parse_yaml(path.read_text()) == found


def test_numbers_may_have_powers_of_ten_without_a_point(monkeypatch):
    text = 'a: [3e6, -1E-3, +2e+5, 3000000, 1.5e3, 12, 0x10, 1e, e5, 1_000, "3e6"]'
    found = {'a': [3e6, -1e-3, 2e5, 3000000, 1500.0, 12, 16, '1e', 'e5', 1000, '3e6']}
    assert parse_yaml(text) == found
    monkeypatch.setattr(strict_yaml, 'QuickLoader', strict_yaml.StrictLoader)
    assert parse_yaml(text) == found


def test_good_file_becomes_frozen_values():
    machine = build(Machine, parse_yaml(GOOD))
    assert machine == Machine(58.0, (30.0, 210.0), (Servo('a', 1, 1500.0),), None)


def test_misspelt_key_names_itself_and_the_nearest():
    found = problems(GOOD.replace('rod_length_mm', 'rod_lenght_mm'))
    assert found == ("rod_lenght_mm: unknown key, did you mean 'rod_length_mm'?",)


def test_everything_wrong_is_reported_at_once():
    text = GOOD.replace('58', '.nan').replace('[30, 210]', '[30]').replace('sign: 1', 'sign: 2')
    found = problems(text + 'label: 7\n')
    assert len(found) == 4
    assert 'rod_length_mm: nan is not finite' in found
    assert 'range_deg: has 1 entry, needs 2' in found
    assert any(p.startswith('servos[0].sign: 2 is not one of -1, 1') for p in found)
    assert 'label: holds the number 7, needs a text' in found


def test_a_number_outside_its_range_is_named_with_both():
    assert problems(GOOD.replace('58', '0.058')) == ('rod_length_mm: 0.058 outside [1, 2000]',)


@dataclass(frozen=True)
class Circle:
    radius_mm: float
    height_mm: float


@dataclass(frozen=True)
class Points:
    points_mm: tuple[float, ...]
    height_mm: float


@dataclass(frozen=True)
class Shape:
    geometry: Circle | Points


@pytest.mark.parametrize(
    'geometry', [{'pionts_mm': [1.0], 'height_mm': 2.0}, {'radius_mm': 1.0, 'points_mm': [1.0]}]
)
def test_a_section_of_no_form_or_of_two_is_told_what_there_is(geometry):
    with pytest.raises(ConfigError, match=r'needs one of radius_mm, points_mm$'):
        build(Shape, {'geometry': geometry})


def test_a_section_of_several_forms_is_of_that_with_most_of_its_keys():
    whole = {'points_mm': [1.0], 'height_mm': 2.0}
    assert build(Shape, {'geometry': whole}) == Shape(Points((1.0,), 2.0))
    with pytest.raises(ConfigError, match="hieght_mm: unknown key, did you mean 'height_mm'"):
        build(Shape, {'geometry': {'points_mm': [1.0], 'hieght_mm': 2.0}})


def test_a_key_of_another_form_is_told_what_it_goes_with():
    @dataclass(frozen=True)
    class Tilted(Points):
        tilt_deg: float

    @dataclass(frozen=True)
    class Shapes:
        geometry: Circle | Tilted

    mixed = {'points_mm': [1.0], 'height_mm': 2.0, 'tilt_deg': 1.0, 'radius_mm': 3.0, 'colour': 1}
    with pytest.raises(ConfigError) as caught:
        build(Shapes, {'geometry': mixed})
    assert caught.value.problems == (
        'geometry.radius_mm: does not go with points_mm',
        'geometry.colour: unknown key',
    )


def test_a_list_that_may_have_two_lengths_is_told_both():
    @dataclass(frozen=True)
    class Ranges:
        ends: tuple[float, float] | tuple[float, float, float]

    assert build(Ranges, {'ends': [1.0, 2.0, 3.0]}).ends == (1.0, 2.0, 3.0)
    with pytest.raises(ConfigError, match='ends: has 4 entries, needs 2 or 3'):
        build(Ranges, {'ends': [1.0] * 4})


def test_value_inside_a_list_is_named_by_its_place():
    (found,) = problems(GOOD.replace('210', '720'))
    assert found.startswith('range_deg[1]: 720 outside')


@pytest.mark.parametrize(
    ('text', 'word'),
    [
        ('a: &x 1\nb: *x', 'aliases'),
        ('a: 1\na: 2', 'duplicated'),
        ('a: !!python/object/apply:os.system ["true"]', 'python/object'),
        ('- 1\n- 2', 'a list'),
        ('', 'nothing'),
        ('a: [1, 2', 'flow sequence'),
        ('a: ' + '[' * 5000 + ']' * 5000, 'deep'),
        ('a: ' + 'x' * 2_000_000, 'characters'),
    ],
)
def test_hostile_or_broken_yaml_is_refused_in_words(text, word):
    with pytest.raises(ConfigError, match=word):
        parse_yaml(text, 'file.yaml')


def test_booleans_are_no_numbers():
    (found,) = problems(GOOD.replace('58', 'true'))
    assert 'needs a number' in found


def test_faults_of_two_sections_are_reported_together():
    good, bad = parse_yaml(GOOD), parse_yaml(GOOD.replace('58', 'long'))
    assert build_both((Machine, good, 'a'), (Machine, good, 'b'))[1] == build(Machine, good)
    with pytest.raises(ConfigError) as error:
        build_both((Machine, bad, 'a'), (Machine, bad, 'b'))
    assert [p.split(':')[0] for p in error.value.problems] == [
        'a.rod_length_mm',
        'b.rod_length_mm',
    ]
