"""A client that enables a machine, in simulated time: no graph, but what its bridge would say."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest

pytest.importorskip('rclpy')

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from hexarm import client
from hexarm.client import DRIVEN_WITHIN, Client
from manipulator.errors import Refused, TimedOut

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
        return SimpleNamespace(success=True, message='')


@pytest.fixture
def enabling(monkeypatch):
    """Makes one; its clock begins at 0."""
    made = []

    def make(bridge):
        clock = SimpleNamespace(now=0.0)
        monkeypatch.setattr(client, 'time', SimpleNamespace(monotonic=lambda: clock.now))
        made.append(Enabling(bridge, clock))
        return made[-1]

    yield make
    for one in made:
        one.__exit__(None, None, None)


def test_enabling_goes_on_for_as_long_as_the_bridge_reports_that_it_arms(enabling):
    long = 4 * DRIVEN_WITHIN

    def bridge(seconds):
        return ('arming', '', 'disabled') if seconds < long else ('enabled', '', 'hold')

    user = enabling(bridge)
    user.enable()
    assert user.motion('mode') == 'hold'


def test_enabling_ends_with_the_reason_where_the_machine_is_stopped_meanwhile(enabling):
    def bridge(seconds):
        return ('arming', '', '') if seconds < 3.0 else ('stopped', 'the stop pin', 'disabled')

    with pytest.raises(Refused, match='not enabled: machine stopped: the stop pin'):
        enabling(bridge).enable()


def test_a_machine_that_is_enabled_but_not_driven_is_not_waited_for_for_ever(enabling):
    with pytest.raises(TimedOut, match='waited 15 s in vain for enabling'):
        enabling(lambda seconds: ('enabled', '', 'disabled')).enable()


def test_a_board_that_is_not_there_is_named(enabling):
    gone = ('disconnected', '/dev/ttyUSB7 does not exist', '')
    with pytest.raises(TimedOut, match=r'in vain for the board .*/dev/ttyUSB7 does not exist'):
        enabling(lambda seconds: gone).enable()
