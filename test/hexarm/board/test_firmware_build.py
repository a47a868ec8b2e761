"""Building the board's program while others do."""

import fcntl

import pytest

from hexarm.board import build as firmware_build
from hexarm.board.header import header_of

BUILDS = {
    'the simulator': firmware_build.simulator,
    'a program': lambda: firmware_build.firmware(header_of('robocake')),
}


@pytest.mark.parametrize('build', BUILDS.values(), ids=BUILDS)
def test_while_something_is_built_no_other_process_builds(chip_tools, monkeypatch, build):
    made = []

    def make(*words):
        lock = firmware_build.FIRMWARE / 'build' / '.lock'
        with lock.open('w') as another, pytest.raises(BlockingIOError):
            fcntl.flock(another, fcntl.LOCK_EX | fcntl.LOCK_NB)
        made.append(words)

    monkeypatch.setattr(firmware_build, '_make', make)
    build()
    assert made


def test_without_the_tools_it_is_said_what_is_missing(monkeypatch):
    monkeypatch.setattr(firmware_build, 'missing_tools', lambda: ['avr-gcc'])
    with pytest.raises(firmware_build.CannotBuild, match='not there: avr-gcc'):
        firmware_build.simulator()
