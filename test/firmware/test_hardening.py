"""The board's program under sanitizers, a fuzzer and static analysis: `make -C firmware …`."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

FIRMWARE = Path(__file__).parents[2] / 'firmware'
FUZZING_S = 60
pytestmark = pytest.mark.processes


@pytest.fixture
def make():
    """Runs make in firmware/, where the tools that it needs are there; what it printed."""

    def run(target, *tools):
        missing = [tool for tool in tools if shutil.which(tool) is None]
        if missing and os.environ.get('REQUIRE_ALL') != '1':
            pytest.skip(f'not installed: {", ".join(missing)}')
        command = ['make', '-C', str(FIRMWARE), f'PYTHON={sys.executable}', *target.split()]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
        return done.stdout + done.stderr

    return run


def test_the_analyzers_find_nothing(make):
    make('analyze', 'gcc', 'cppcheck')


def test_the_tests_of_the_board_pass_under_the_sanitizers(make):
    assert ' passed' in make('sanitize', 'gcc')


def test_a_fuzzer_that_is_guided_by_coverage_finds_nothing(make):
    assert 'stat::number_of_executed_units' in make(f'fuzz SECONDS={FUZZING_S}', 'clang')
