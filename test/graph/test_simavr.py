"""`hexarm up hexapod --port simavr`: the whole graph against the firmware on a simulated chip."""

import signal
import time

import pytest

pytestmark = [pytest.mark.graph, pytest.mark.usefixtures('chip_tools')]


def up(hexarm):
    """`hexarm up` against the chip, enabled."""
    process = hexarm('up', 'hexapod', '--port', 'simavr')
    said = ''
    while 'is up on simavr and enabled' not in said:
        line = process.stdout.readline()
        assert line, said
        said += line
    return process


def test_the_graph_enables_parks_and_leaves_no_chip_behind(hexarm, processes_left):
    process = up(hexarm)
    (chip,) = [pid for pid, words in processes_left().items() if 'pty_chip' in words]
    process.send_signal(signal.SIGINT)
    rest = process.stdout.read()
    assert process.wait(60) == 0
    assert 'parking' in rest
    assert 'not parked' not in rest
    assert chip not in processes_left()


def test_the_chip_ends_when_up_itself_is_killed(hexarm, processes_left):
    process = up(hexarm)
    process.kill()
    process.wait()
    deadline = time.monotonic() + 60.0
    while processes_left() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert processes_left() == {}
