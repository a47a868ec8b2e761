"""firmware/core is portable, and its includes point one way."""

import re
from pathlib import Path

import pytest

FIRMWARE = Path(__file__).parents[2] / 'firmware'
CORE, AVR, HOST = (FIRMWARE / name for name in ('core', 'avr', 'host'))
STANDARD = {'stdbool.h', 'stdint.h', 'stddef.h', 'string.h', 'math.h'}


def included(file):
    """Names that a file includes: in angle brackets, in quotes."""
    text = file.read_text()
    return [set(re.findall(pattern, text)) for pattern in (r'#include <(.+)>', r'#include "(.+)"')]


def test_the_program_includes_itself_the_kernel_and_standard_headers():
    own = {path.name for path in CORE.glob('*.h')} | {'target.h'}
    for file in (*CORE.glob('*.c'), *CORE.glob('*.h')):
        standard, ours = included(file)
        assert standard <= STANDARD, file.name
        assert all(name in own or name.startswith('../../kernel/') for name in ours), file.name


@pytest.mark.parametrize('folder', [AVR, HOST])
def test_each_hardware_layer_defines_all_that_the_program_asks_for(folder):
    header = (CORE / 'hardware.h').read_text()
    needed = set(re.findall(r'^\w+ (hardware_\w+)\(', header, re.MULTILINE))
    text = ''.join(path.read_text() for path in folder.glob('*.c'))
    assert len(needed) > 10
    assert needed == set(re.findall(r'^\w+ (hardware_\w+)\([^;]*$', text, re.MULTILINE))
    for macro in ('STATE', 'MACHINE'):
        assert macro in (folder / 'target.h').read_text()


def needs(module):
    """The modules of the program whose headers a module's two files include."""
    files = (CORE / f'{module}.c', CORE / f'{module}.h')
    found = set().union(*(included(file)[1] for file in files if file.exists()))
    return {Path(name).stem for name in found} - {module, 'target'}


def test_no_two_files_of_the_program_need_each_other():
    modules = {path.stem for path in CORE.glob('*.[ch]')}
    left = {module: needs(module) & modules for module in modules}
    while left:
        free = {module for module, others in left.items() if not others & left.keys()}
        assert free, f'a circle: {sorted(left)}'
        left = {module: others for module, others in left.items() if module not in free}


def test_every_variable_that_outlives_a_call_is_marked():
    """An unmarked one would be shared by all boards of a process."""
    for file in CORE.glob('*.c'):
        for line in file.read_text().splitlines():
            is_variable = re.match(r'\s*static (?!inline|const|STATE)[^()]*[;=]', line)
            assert not is_variable, f'{file.name}: {line}'
