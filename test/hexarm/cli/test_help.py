"""Every subcommand: its help, its example, and what is imported for it."""

import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from hexarm.cli import commands
from hexarm.cli.commands import BY_NAME, COMMANDS
from hexarm.cli.main import main, parser_for

pytest.importorskip('rclpy')
CLI = Path(commands.__file__).parent


@pytest.mark.parametrize('command', COMMANDS, ids=lambda command: command.name)
def test_help_is_a_sentence_and_an_example_that_is_understood(command, capsys):
    with pytest.raises(SystemExit) as ended:
        main([command.name, '--help'])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    sentence = f'{command.help[0].upper()}{command.help[1:]}.'
    assert sentence in ' '.join(said.split())
    assert f'example:\n  hexarm {command.example}' in said
    words = shlex.split(command.example)
    assert words[0] == command.name
    assert callable(parser_for(words).parse_args(words).run)


INTERACTIVE = {'up', 'foxglove', 'new', 'calibrate'}
"""They run, or ask; and what firmware-header prints is for a compiler."""


@pytest.mark.parametrize('command', COMMANDS, ids=lambda command: command.name)
def test_every_command_that_prints_data_prints_it_for_programs_too(command):
    if command.name not in {*INTERACTIVE, 'firmware-header'}:
        words = [*shlex.split(command.example), '--json']
        assert parser_for(words).parse_args(words).json


def test_no_module_of_a_subcommand_is_left_out_of_the_list():
    declared = {c.module.rpartition('.')[2] for c in COMMANDS}
    files = {p.stem for p in CLI.glob('*.py') if '\ndef add_parser(' in p.read_text()}
    assert files <= declared
    assert len(BY_NAME) == len(COMMANDS)


HEAVY = {'numpy', 'rclpy', 'scipy', 'matplotlib', 'mujoco', 'viser', 'rich', 'mcap'}


@pytest.mark.parametrize(
    ('words', 'allowed'),
    [
        (['--help'], set()),
        (['--version'], set()),
        (['ik', 'robocake', '--xyz', '0', '0', '0.045'], {'numpy'}),
        (['fk', 'robocake', *['2.1'] * 6], {'numpy', 'scipy'}),  # for the other modes
        (['machines'], {'numpy'}),
        (['check', 'ur5'], {'numpy', 'scipy'}),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else None,
)
def test_a_subcommand_imports_what_it_needs_and_no_other_subcommand(words, allowed):
    own = BY_NAME[words[0]].module if words[0] in BY_NAME else ''
    code = (
        'import sys, contextlib\nfrom hexarm.cli.main import main\n'
        f'with contextlib.suppress(SystemExit): main({words!r})\n'
        f'others = {{m for m in sys.modules if m in {[c.module for c in COMMANDS]!r}}}\n'
        f'print(sorted((others - {{{own!r}}}) | ({HEAVY!r} & set(sys.modules))), file=sys.stderr)'
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=False, timeout=120
    )
    assert set(eval(done.stderr.splitlines()[-1])) <= allowed
