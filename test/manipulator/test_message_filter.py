"""Which messages count, by their stamps and by what becomes of them."""

import pytest

from manipulator.errors import InvalidInput
from manipulator.message_filter import LONGEST_REASON, MessageFilter

EPOCH = 1.7e9


@pytest.fixture
def messages():
    """A filter on a computer whose clock was EPOCH at time zero."""
    return MessageFilter(EPOCH)


def refuse(reason='no'):
    raise InvalidInput(reason)


def test_a_good_message_is_accepted_once_and_its_time_noted(messages):
    taken = []
    assert messages.age(3.0) == float('inf')
    assert messages.take(EPOCH + 1.0, lambda: taken.append(1), 1.01) is None
    assert taken == [1]
    assert messages.age(3.0) == pytest.approx(1.99)
    assert (messages.refused, messages.last_refusal) == (0, '')


def test_a_stale_message_is_not_accepted_and_reports_why(messages):
    taken = []
    messages.take(EPOCH + 1.0, lambda: taken.append('first'), 1.0)
    error = messages.take(EPOCH + 1.1, lambda: taken.append('late'), 1.8)
    assert '0.700 s old' in str(error)
    assert taken == ['first']
    assert messages.age(1.8) == pytest.approx(0.8)


def test_how_late_a_message_is_can_be_asked_while_it_is_accepted(messages):
    late = []
    stamps = ((EPOCH + 1.0, 1.003), (EPOCH + 1.1, 1.303), (0.0, 1.4), (EPOCH + 1.4, 1.403))
    for stamp, receipt in stamps:
        assert messages.take(stamp, lambda: late.append(messages.lateness), receipt) is None
    assert late == pytest.approx([0.0, 0.2, 0.0, 0.0], abs=1e-6)


def test_what_is_refused_is_counted_and_is_no_good_message(messages):
    error = messages.take(EPOCH, refuse, 0.0)
    assert str(error) == 'no'
    messages.refuse(InvalidInput('not in the end'))
    assert (messages.refused, messages.last_refusal) == (2, 'not in the end')
    assert messages.age(0.0) == float('inf')


def test_an_endless_reason_is_cut(messages):
    messages.take(EPOCH, lambda: refuse('x' * 1_000_000), 0.0)
    assert len(messages.last_refusal) == LONGEST_REASON


def test_messages_without_a_stamp_are_always_fresh(messages):
    taken = []
    for now in (1.0, 5.0, 5.001):
        assert messages.take(0.0, lambda: taken.append(1), now) is None
    assert len(taken) == 3


@pytest.mark.parametrize(('ahead', 'notable'), [(3600.0, 3600.0), (-2.0, -2.0), (0.2, 0.0)])
def test_the_clock_of_the_source_is_compared_with_ours(messages, ahead, notable):
    assert messages.clock_offset == 0.0
    messages.take(EPOCH + 1.0 + ahead, list, 1.0)
    assert messages.clock_offset == pytest.approx(notable)
