import pytest

from manipulator.errors import Refused
from manipulator.trajectory.early_command import PATIENCE, EarlyCommand
from manipulator.trajectory.supervisor import NotYet


class Machine:
    """Raises `missing` while it cannot be driven."""

    def __init__(self):
        self.missing = NotYet('its pose is not known yet')
        self.done, self.refused = [], []
        self.early = EarlyCommand()

    def ask(self, name, now=0.0):
        self.early.take(lambda: self._do(name), lambda error: self._refuse(name, error), now)

    def _do(self, name):
        if self.missing is not None:
            raise self.missing
        self.done.append(name)

    def _refuse(self, name, error):
        self.refused.append((name, str(error)))


@pytest.fixture
def machine():
    return Machine()


def test_what_can_be_done_is_done_at_once_and_what_cannot_is_refused_at_once(machine):
    machine.missing = None
    machine.ask('goal')
    assert machine.done == ['goal']
    machine.missing = Refused('clear the stop first')
    with pytest.raises(Refused, match='clear the stop first'):
        machine.ask('goal')
    machine.missing = None
    machine.early.poll(0.01)
    assert machine.done == ['goal']


def test_what_came_too_early_is_done_once_as_soon_as_it_can_be(machine):
    machine.ask('goal')
    machine.early.poll(0.01)
    machine.missing = None
    machine.early.poll(0.02)
    machine.early.poll(0.03)
    assert (machine.done, machine.refused) == (['goal'], [])


def test_patience_ends_with_what_was_missing_last(machine):
    machine.ask('goal')
    machine.missing = NotYet('the board does not follow setpoints yet')
    machine.early.poll(0.9 * PATIENCE)
    assert machine.refused == []
    machine.missing = None  # too late: whoever asked may have gone on to something else
    machine.early.poll(1.1 * PATIENCE)
    assert machine.refused == [('goal', 'the board does not follow setpoints yet')]
    assert machine.done == []


def test_a_stream_of_goals_does_not_wait_for_ever_either(machine):
    for k in range(100):
        now = 0.03 * k
        machine.early.poll(now)
        machine.ask(k, now)
    assert 2 <= len(machine.refused) <= 3


def test_of_two_that_come_too_early_the_newer_one_is_done(machine):
    machine.ask('old')
    machine.ask('new')
    machine.missing = None
    machine.early.poll(0.01)
    assert (machine.done, machine.refused) == (['new'], [])


def test_one_that_is_done_at_once_takes_the_place_of_the_one_that_waits(machine):
    machine.ask('old')
    machine.missing = None
    machine.ask('new')
    machine.early.poll(0.01)
    assert (machine.done, machine.refused) == (['new'], [])


def test_a_command_that_is_refused_for_itself_does_not_displace_the_one_that_waits(machine):
    machine.ask('good')
    soon, machine.missing = machine.missing, Refused('quaternion has length 0')
    with pytest.raises(Refused, match='quaternion'):
        machine.ask('bad')
    machine.missing = soon
    machine.early.poll(0.01)
    machine.missing = None
    machine.early.poll(0.02)
    assert (machine.done, machine.refused) == (['good'], [])


def test_a_stop_refuses_what_waits_and_it_does_not_begin_later(machine):
    machine.ask('goal')
    machine.missing = Refused('the machine is stopped: clear the stop first')
    machine.early.poll(0.01)
    machine.missing = None
    machine.early.poll(0.02)
    assert machine.refused == [('goal', 'the machine is stopped: clear the stop first')]
    assert machine.done == []


def test_what_is_dropped_is_refused_with_the_reason(machine):
    machine.early.drop('nothing waits')
    machine.ask('goal')
    machine.early.drop('stopped before it began')
    machine.missing = None
    machine.early.poll(0.01)
    assert machine.refused == [('goal', 'stopped before it began')]
    assert machine.done == []
