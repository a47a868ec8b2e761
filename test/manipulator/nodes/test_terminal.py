"""A terminal hands over each key at once, and is put right again whatever ends its program."""

import os
import pty
import signal
import termios

import pytest

from hexarm.nodes import keyboard_teleop
from manipulator.errors import InvalidInput
from manipulator.nodes.devices.terminal import Terminal


class Desk:
    """A pseudo-terminal that is the standard input of this process."""

    def __init__(self, monkeypatch):
        self.keys, self.screen = pty.openpty()
        self._before = termios.tcgetattr(self.screen)
        monkeypatch.setattr('sys.stdin', os.fdopen(self.screen, 'r', closefd=False))

    def is_as_before(self):
        return termios.tcgetattr(self.screen) == self._before

    def close_window(self):
        os.close(self.keys)
        self.keys = None

    def close(self):
        os.close(self.screen)
        if self.keys is not None:
            os.close(self.keys)


@pytest.fixture
def desk(monkeypatch):
    desk = Desk(monkeypatch)
    yield desk
    desk.close()


@pytest.fixture
def signals():
    """This process's own, afterwards."""
    kept = {number: signal.getsignal(number) for number in (signal.SIGHUP, signal.SIGINT)}
    kept[signal.SIGTERM] = signal.getsignal(signal.SIGTERM)
    yield
    for number, handler in kept.items():
        signal.signal(number, handler)


def test_keys_come_one_by_one_without_a_line_end_and_ctrl_z_is_one_of_them(desk):
    with Terminal() as terminal:
        assert terminal.read() == b''
        os.write(desk.keys, b'w\x1a')
        assert terminal.read() == b'w\x1a'


def test_it_is_as_before_after_a_clean_end_and_after_an_error(desk):
    with Terminal():
        assert not desk.is_as_before()
    assert desk.is_as_before()
    with pytest.raises(ValueError, match='broken'), Terminal():
        raise ValueError('broken')
    assert desk.is_as_before()


def test_a_window_that_was_closed_reads_as_none_and_can_be_left(desk):
    with Terminal() as terminal:
        desk.close_window()
        assert terminal.read() is None
        terminal.show('nobody sees this')


def test_no_terminal_is_reported_in_one_line_and_status_1(monkeypatch, capsys, signals, tmp_path):
    (tmp_path / 'script').touch()
    monkeypatch.setattr('sys.stdin', (tmp_path / 'script').open())
    with pytest.raises(InvalidInput, match='standard input is none'):
        Terminal()
    assert keyboard_teleop() == 1
    text = 'keyboard_teleop: needs a terminal to read keys from, standard input is none\n'
    assert capsys.readouterr().err == text


def test_a_bad_parameter_is_reported_and_the_terminal_is_as_before(
    monkeypatch, capsys, signals, desk
):
    arguments = ['keyboard_teleop', '--ros-args', '-p', 'rate:=1.0']
    monkeypatch.setattr('sys.argv', arguments)
    assert keyboard_teleop() == 1
    assert 'rate' in capsys.readouterr().err
    assert desk.is_as_before()
