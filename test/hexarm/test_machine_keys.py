"""The keys of machine files: the page, the editors' schema and what checks files say the same."""

import json
from pathlib import Path

import jsonschema
import pytest

from hexarm import machine_keys
from hexarm.machine_check import problems_of
from hexarm.machine_keys import KINDS, keys_of, sections_of
from hexarm.machines import KINDS as LOADED
from leg_kinds import FOLDER
from manipulator.config import forms_of, parse_yaml
from manipulator.machine import MachineFile
from sampling import enough

CONFIG = Path(__file__).parents[2] / 'config'
MACHINES = [path for path in sorted(CONFIG.glob('*.yaml')) if 'kind:' in path.read_text()]
MACHINES += sorted(FOLDER.glob('*.yaml'))
REAL = sorted(Path(__file__).with_name('machines').glob('*.yaml'))
VALIDATOR = jsonschema.Draft7Validator(json.loads(machine_keys.SCHEMA.read_text()))
WRITE = 'write it anew: python -m hexarm.machine_keys'


def keys():
    yield from keys_of(MachineFile)
    for kind in KINDS:
        for schema in sections_of(kind).values():
            for form in forms_of(schema):
                yield from keys_of(form)


def test_every_key_has_a_meaning():
    assert [key.place for key in keys() if not key.field.metadata.get('meaning')] == []


def test_every_kind_that_can_be_loaded_has_keys():
    assert set(KINDS) == set(LOADED)


def test_page_and_schema_are_of_the_keys_that_there_are():
    text = machine_keys.PAGE.read_text()
    assert machine_keys.page(text) == text, WRITE
    assert machine_keys.schema_text() == machine_keys.SCHEMA.read_text(), WRITE
    for key in keys():
        assert f'{key.field.name}` |' in text


@pytest.mark.parametrize('path', MACHINES + REAL, ids=lambda path: path.stem)
def test_files_of_real_machines_fit_the_schema(path):
    VALIDATOR.validate(parse_yaml(path.read_text()))


@pytest.mark.parametrize('kind', KINDS)
def test_what_does_not_fit_the_schema_is_a_problem(kind):
    """A value taken out, of another type, or with another key beside it: every tenth in turn."""
    text = next(t for t in map(Path.read_text, MACHINES) if f'kind: {kind}\n' in t)
    for first, damage in enumerate((take_out, make_a_list, add_a_key)):
        for place in list(places(parse_yaml(text)))[first :: enough(10, 3)]:
            content = parse_yaml(text)
            damage(content, place)
            if not VALIDATOR.is_valid(content):
                assert problems_of(json.dumps(content)), (damage, place)
            elif damage is add_a_key:
                assert problems_of(json.dumps(content)) == []


def places(content, place=()):
    for key, value in content.items():
        yield (*place, key)
        if isinstance(value, dict):
            yield from places(value, (*place, key))


def holder(content, place):
    for key in place[:-1]:
        content = content[key]
    return content


def take_out(content, place):
    del holder(content, place)[place[-1]]


def make_a_list(content, place):
    holder(content, place)[place[-1]] = ['none']


def add_a_key(content, place):
    holder(content, place)['none_such'] = 1.0
