"""`hexarm up hexapod --port simavr`: the whole graph against the firmware on a simulated chip."""

import signal

import pytest

pytestmark = [pytest.mark.graph, pytest.mark.usefixtures('chip_tools')]


def test_the_graph_enables_parks_and_leaves_no_chip_behind(hexarm, processes_left):
    process = hexarm('up', 'hexapod', '--port', 'simavr')
    text = ''
    while 'is up on simavr and enabled' not in text:
        line = process.stdout.readline()
        assert line, text
        text += line
    (chip,) = [pid for pid, words in processes_left().items() if 'pty_chip' in words]
    process.send_signal(signal.SIGINT)
    rest = process.stdout.read()
    assert process.wait(60) == 0
    assert 'park' in rest
    assert chip not in processes_left()
