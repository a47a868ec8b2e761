"""A client in simulated time: no graph, but what its bridge and its trajectory would publish."""

import signal
import subprocess
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest

pytest.importorskip('rclpy')

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from hexarm import graph_client
from hexarm.client import DRIVEN_WITHIN, Client, Pursued
from manipulator.errors import Refused, Stopped, TimedOut

SAID_EVERY = 0.5


def status(message, **values):
    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticStatus(message=message, values=pairs)


class Enabling(Client):
    """Hears every half second what `bridge(seconds)` returns: machine state, its reason, mode."""

    def __init__(self, bridge, clock):
        super().__init__('simulated')
        self._bridge, self._clock, self._next = bridge, clock, 0.0
        self.node.create_client = MagicMock()

    def spin(self, seconds):
        self._clock.now += seconds
        while self._next <= self._clock.now:
            state, reason, mode = self._bridge(self._next)
            self._on_machine_state(status(state, reason=reason))
            self._on_motion_status(status('', mode=mode))
            self._next += SAID_EVERY

    def answer_of(self, *_):
        return SimpleNamespace(success=True, message='arming')


@pytest.fixture
def enabling(monkeypatch):
    """Makes one; its clock begins at 0."""
    made = []

    def make(bridge):
        clock = SimpleNamespace(now=0.0)
        monkeypatch.setattr(graph_client, 'time', SimpleNamespace(monotonic=lambda: clock.now))
        made.append(Enabling(bridge, clock))
        return made[-1]

    yield make
    for one in made:
        one.__exit__(None, None, None)


def test_enabling_goes_on_for_as_long_as_the_bridge_reports_that_it_arms(enabling):
    long = 4 * DRIVEN_WITHIN

    def bridge(seconds):
        return ('arming', '', 'disabled') if seconds < long else ('enabled', '', 'hold')

    user, answers = enabling(bridge), []
    user.enable(report=answers.append)
    assert user.motion('mode') == 'hold'
    assert answers == ['arming']


def test_enabling_ends_with_the_reason_where_the_machine_is_stopped_meanwhile(enabling):
    def bridge(seconds):
        return ('arming', '', '') if seconds < 3.0 else ('stopped', 'the stop pin', 'disabled')

    with pytest.raises(Refused, match='not enabled: machine stopped: the stop pin'):
        enabling(bridge).enable()


def test_a_machine_that_is_enabled_but_not_driven_is_not_waited_for_for_ever(enabling):
    with pytest.raises(TimedOut, match='timed out after 15 s, waiting for enabling'):
        enabling(lambda seconds: ('enabled', '', 'disabled')).enable()


def test_a_board_that_is_not_there_is_named(enabling):
    gone = ('disconnected', '/dev/ttyUSB7 does not exist', '')
    with pytest.raises(TimedOut, match=r'waiting for the board .*/dev/ttyUSB7 does not exist'):
        enabling(lambda seconds: gone).enable()


class GoingHome(Client):
    """Receives one of `statuses` (goal_stamp, result) at each wait; its request is answered."""

    def __init__(self, *statuses):
        super().__init__('simulated')
        self.statuses = list(statuses)
        self.node.create_client = MagicMock()

    def spin(self, seconds):
        stamp, result = self.statuses.pop(0)
        self._on_motion_status(status(result, goal_stamp=stamp, result=result))

    def answer_of(self, *_):
        return SimpleNamespace(success=True, message='going home, goal_stamp 7.000000000')


def test_home_does_not_take_the_result_of_an_older_goal_for_its_own():
    home = '7.000000000'
    with GoingHome(('5.0', 'reached'), (home, 'moving'), (home, 'reached')) as user:
        user.home()
        assert not user.statuses


def test_home_that_is_stopped_raises_the_reason():
    home = '7.000000000'
    with GoingHome((home, 'moving'), (home, 'stopped')) as user, pytest.raises(Stopped):
        user.home()


def goal(stamp, result, reason=''):
    return status(f'{result}: {reason}', goal_stamp=stamp, result=result, reason=reason)


@pytest.mark.parametrize('result', ['moving', 'reached', 'stopped'])
def test_a_goal_whose_place_another_has_taken_is_stopped(result):
    pursued = Pursued('1.0')
    pursued.note(goal('1.0', 'moving'))
    pursued.note(goal('2.0', result))
    assert (pursued.result, pursued.text) == ('stopped', 'another goal took its place')


def test_a_refusal_or_the_planning_of_another_goal_does_not_end_one():
    pursued = Pursued('1.0')
    for other in (goal('0.5', 'reached'), goal('1.0', 'moving'), goal('2.0', 'planning')):
        pursued.note(other)
    pursued.note(goal('2.0', 'refused', 'out of reach'))
    assert pursued.result == 'moving'
    pursued.note(goal('1.0', 'reached'))
    pursued.note(goal('3.0', 'moving'))
    assert pursued.result == 'reached'


def test_the_text_of_a_refusal_is_its_reason():
    pursued = Pursued('1.0')
    pursued.note(goal('1.0', 'refused', 'leg 5: rod too short'))
    assert pursued.text == 'leg 5: rod too short'


@pytest.mark.processes
def test_a_client_that_cannot_leave_the_graph_does_not_keep_its_process():
    """Fast DDS now and then waits for itself, with the interpreter's lock."""
    program = (
        'import ctypes\n'
        'from hexarm import graph_client\n'
        'graph_client.LEAVES_WITHIN = 0.5\n'
        'with graph_client.GraphClient("simulated") as client:\n'
        '    client.node.destroy_node = lambda: ctypes.PyDLL(None).sleep(600)\n'
    )
    done = subprocess.run([sys.executable, '-c', program], check=False, timeout=120)
    assert done.returncode == 1


class InterruptedAsItGoes:
    """Ctrl-C comes while Python deletes it, where a KeyboardInterrupt would be dropped."""

    def __del__(self):
        signal.raise_signal(signal.SIGINT)


@pytest.fixture
def ctrl_c_raises():
    """Also where the tests run in the background, in which a shell has SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_in_any_place_of_a_callback_ends_a_wait_and_the_client_goes_on(ctrl_c_raises):
    ticks = []

    def tick():
        ticks.append(None)
        if len(ticks) == 1:
            InterruptedAsItGoes()

    with Client('interrupted') as client:
        client.node.create_timer(0.01, tick)
        with pytest.raises(KeyboardInterrupt):
            client.wait('Ctrl-C', lambda: len(ticks) > 1, 60.0)
        client.wait('another callback', lambda: len(ticks) > 1, 60.0)


@pytest.mark.processes
def test_a_client_in_a_program_s_own_context_leaves_it_its_ctrl_c():
    """rclpy's handler is none of Python's: it could not be put back."""
    program = (
        'import os, signal, threading, rclpy\n'
        'signal.signal(signal.SIGINT, signal.default_int_handler)\n'
        'from rclpy.executors import ExternalShutdownException\n'
        'from hexarm.client import Client\n'
        'rclpy.init()\n'
        'node = rclpy.create_node("mine")\n'
        'with Client("simulated") as client:\n'
        '    client.spin(0.2)\n'
        'threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n'
        'try:\n'
        '    rclpy.spin(node)\n'
        'except (KeyboardInterrupt, ExternalShutdownException):\n'
        '    print("ended")\n'
    )
    command = [sys.executable, '-c', program]
    done = subprocess.run(command, check=False, timeout=120, capture_output=True, text=True)
    assert done.stdout == 'ended\n', done.stderr
