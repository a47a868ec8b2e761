"""The tests of the board on its program under the sanitizers: `make -C firmware sanitize`."""

import sys
from pathlib import Path

import pytest

from bridge.fake import program

ROOT = Path(__file__).resolve().parents[2]
TESTS = (
    'contracts',
    'bridge/fake/test_board.py',
    'firmware/test_link.py',
    'firmware/test_wire.py',
)
OURS = 'not chip and not another_version'
"""The chip's program is not instrumented, and a process opens one library only."""
OPTIONS = ('-q', '-s', '-p', 'no:xdist', '-p', 'no:cacheprovider')


def main() -> int:
    """Runs them on the library that the command line names."""
    program.LIBRARY = Path(sys.argv[1]).resolve()
    tests = [str(ROOT / 'test' / test) for test in TESTS]
    return int(pytest.main([*tests, *OPTIONS, '-k', OURS]))


if __name__ == '__main__':
    sys.exit(main())
