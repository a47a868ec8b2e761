"""Machine files that were damaged, or made to do harm: words, not tracebacks, and soon."""

import os
import random
import re
import time
from pathlib import Path

import pytest

from hexarm import machines
from hexarm.machine_check import problems_of
from manipulator.config import MAX_CHARACTERS, parse_yaml
from manipulator.errors import ConfigError
from sampling import enough

ROOT = Path(__file__).resolve().parents[2]
TOKENS = (
    '.nan', '.inf', '-1', '1e400', '9' * 400, '9' * 5000, '2001-99-99', '!!binary x',
    '!!set {a}', '? [a]\n: b', '? {a: 1}\n: b', '<<: {a: 1}', '&a', '*a', '!!python/tuple [1]',
    '{', '}', '[', ']', ': ', '- ', '|', '>', '"', "'", '#', '\t', '\0', 'true', 'null', '~',
    '1:30', 'é', '---', '...',
)  # fmt: skip
TEXTS = [path.read_text() for path in sorted((ROOT / 'config').glob('*.yaml'))]


def damaged(text, chance):
    """One to four cuts, insertions, changed letters, or values put in place of others."""
    for _ in range(chance.randint(1, 4)):
        begin = chance.randrange(len(text))
        end = begin + chance.randint(0, 30)
        if chance.random() < 0.4:
            value = chance.choice(list(re.finditer(r': *([^\n#]+)', text)) or [None])
            begin, end = value.span(1) if value else (begin, end)
        text = text[:begin] + chance.choice([*TOKENS, '', chr(chance.randrange(128))]) + text[end:]
    return text


def test_damaged_machine_files_are_refused_in_words_and_soon():
    chance, slowest = random.Random(7), 0.0
    for _ in range(enough(200, 5000)):
        text = damaged(chance.choice(TEXTS), chance)
        begin = time.process_time()
        problems_of(text)
        slowest = max(slowest, time.process_time() - begin)
    assert slowest < 5.0


@pytest.mark.parametrize(
    'value',
    ['9' * 400, '9' * 5000, '2001-99-99', '!!python/object/apply:os.system ["true"]', '&a [*a]'],
)
def test_value_that_cannot_be_is_named_and_no_traceback(tmp_path, value):
    text = (ROOT / 'config' / 'robocake.yaml').read_text()
    path = tmp_path / 'machine.yaml'
    path.write_text(re.sub('crank_length_mm: .*', f'crank_length_mm: {value}', text))
    with pytest.raises(ConfigError, match=re.escape(str(path))):
        machines.load(str(path))


@pytest.mark.parametrize('text', ['? [a]\n: b', '? {a: 1}\n: b', 'a: 2001-99-99', 'a: !!int x'])
def test_keys_and_values_that_cannot_be_made_are_refused(text):
    with pytest.raises(ConfigError):
        parse_yaml(text)


def test_a_machine_is_described_in_one_line_with_its_file(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text((ROOT / 'config' / 'stewart_6_3.yaml').read_text())
    said = machines.described(str(tmp_path / '.' / 'mine.yaml'))
    assert said.startswith(f'machine mine: {path} (linear hexapod; Gough-Stewart platform')


def test_anchor_bomb_is_refused_before_it_grows():
    lines = ['a0: &a0 [x, x, x, x, x, x, x, x, x]']
    lines += [f'a{k}: &a{k} [{", ".join([f"*a{k - 1}"] * 9)}]' for k in range(1, 12)]
    with pytest.raises(ConfigError, match='aliases are not allowed'):
        parse_yaml('\n'.join(lines))


def test_huge_file_is_refused_without_reading_it(tmp_path, monkeypatch):
    path = tmp_path / 'machine.yaml'
    with path.open('wb') as file:
        file.truncate(100_000_000)
    monkeypatch.setattr(Path, 'read_text', lambda *a, **k: pytest.fail('was read'))
    with pytest.raises(ConfigError, match='100000000 bytes'):
        machines.load(str(path))


def test_largest_file_is_read_in_bounded_time():
    text = 'a: [' + '1,' * (MAX_CHARACTERS // 2 - 10) + ']'
    begin = time.process_time()
    parse_yaml(text)
    assert time.process_time() - begin < 30.0


@pytest.mark.parametrize('kind', ['folder', 'device', 'pipe'])
def test_what_is_no_file_is_no_machine(tmp_path, kind):
    path = {'folder': tmp_path, 'device': Path('/dev/zero'), 'pipe': tmp_path / 'pipe'}[kind]
    if kind == 'pipe':
        os.mkfifo(path)
    with pytest.raises(ConfigError, match='is not a file'):
        machines.load(str(path))
