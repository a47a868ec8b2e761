"""What the shell offers, with argcomplete."""

import os
import subprocess
import sys

import pytest

pytest.importorskip('argcomplete')


def offered(line):
    """What argcomplete writes to file descriptor 8 for a line that ends at the cursor."""
    reader, writer = os.pipe()
    environment = os.environ | {
        '_ARGCOMPLETE': '1',
        '_ARGCOMPLETE_IFS': '\n',
        'COMP_LINE': line,
        'COMP_POINT': str(len(line)),
    }
    program = f'import os, sys; os.dup2({writer}, 8); from hexarm.cli.main import main; main()'
    subprocess.run(
        [sys.executable, '-c', program], env=environment, pass_fds=[writer], timeout=120,
        check=False, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(writer)
    with os.fdopen(reader) as answer:
        return {word.strip() for word in answer.read().split('\n')}


@pytest.mark.parametrize(
    ('line', 'words'),
    [
        ('hexarm re', {'record', 'reach', 'reproduce'}),
        ('hexarm ik robo', {'robocake'}),
        ('hexarm ik robocake --un', {'--units'}),
        ('hexarm ik robocake --units ', {'si', 'mm'}),
    ],
)
def test_commands_machines_and_options_are_completed(line, words):
    assert words <= offered(line)
