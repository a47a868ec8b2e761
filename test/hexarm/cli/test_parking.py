"""How `hexarm up` ends: it parks, or says why not and asks before it lets go."""

from types import SimpleNamespace

import pytest

pytest.importorskip('rclpy')

from hexarm.cli.running.leaving import park
from hexarm.cli.running.up import enable
from manipulator.errors import Refused, Stopped
from manipulator.nodes.stop_signal import Interrupted


class User:
    """A client whose machine is in a state, and which may be interrupted while it waits."""

    def __init__(self, state='enabled', parking=None, interruptions=0):
        self.machine_state = SimpleNamespace(message=state)
        self.parking, self.interruptions = parking, interruptions
        self.asked = []

    def wait(self, *_):
        pass

    def motion(self, key):
        return 'hold'

    def park(self):
        self.asked.append('park')
        if self.parking is not None:
            raise self.parking

    def disable(self):
        self.asked.append('disable')

    def spin(self, seconds):
        if self.interruptions == 0:
            self.machine_state.message = 'disconnected'  # the cable: the test must end
            return
        self.interruptions -= 1
        if self.interruptions == 0:
            raise Interrupted('interrupted')


@pytest.fixture
def stop():
    return SimpleNamespace(is_set=True)


def terminal(monkeypatch, is_there):
    monkeypatch.setattr('sys.stdin', SimpleNamespace(isatty=lambda: is_there))


def test_a_machine_that_can_park_parks_and_is_switched_off(stop, capsys):
    user = User()
    park(user, stop)
    assert user.asked == ['park', 'disable']
    assert 'not parked' not in capsys.readouterr().out


@pytest.mark.parametrize('error', [Refused('joint 6 in the way'), Stopped('braked')])
def test_in_a_terminal_a_second_ctrl_c_releases_what_cannot_park(monkeypatch, stop, capsys, error):
    terminal(monkeypatch, True)
    user = User(parking=error, interruptions=3)
    park(user, stop)
    assert user.asked == ['park', 'disable']
    text = capsys.readouterr().out
    assert f'not parked: {error}' in text
    assert 'Ctrl-C switches them off here' in text


def test_in_a_terminal_nothing_is_released_without_an_answer(monkeypatch, stop):
    terminal(monkeypatch, True)
    user = User(parking=Refused('no'), interruptions=0)
    park(user, stop)
    assert user.asked == ['park']


@pytest.mark.parametrize('state', ['stopped', 'holding', 'fault', 'playing', 'arming'])
def test_without_a_terminal_a_machine_that_cannot_park_is_left_holding(
    monkeypatch, stop, capsys, state
):
    terminal(monkeypatch, False)
    user = User(state)
    park(user, stop)
    assert user.asked == []
    text = capsys.readouterr().out
    assert f'not parked: the machine is {state}' in text
    assert 'the board acts as set by on_link_loss' in text
    assert 'hexarm disable' not in text  # once the graph has ended nobody would hear it


def test_ctrl_c_while_it_parks_switches_the_servos_off_where_they_are(stop, capsys):
    user = User(parking=Interrupted('interrupted'))
    park(user, stop)
    assert user.asked == ['park', 'disable']
    assert 'Ctrl-C again switches the servos off where they are' in capsys.readouterr().out


@pytest.mark.parametrize('state', ['disarmed', 'disconnected', 'booting'])
def test_servos_that_are_off_need_no_parking(stop, state):
    user = User(state)
    park(user, stop)
    assert user.asked == []


def test_what_the_servos_do_is_printed_as_the_bridge_answers(capsys):
    answer = 'enabled: the servos are on already, nothing moves'
    enable(SimpleNamespace(enable=lambda report: report(answer)), 'hexapod')
    assert capsys.readouterr().out == f'enabling\n{answer}\n'
