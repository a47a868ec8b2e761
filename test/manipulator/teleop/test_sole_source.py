"""Two publishers on one topic are noticed before a message of the second one counts."""

import itertools
import random

import pytest

from manipulator.teleop.arbiter import OVERLAP, QUIET, SoleSource

RATES = (20.0, 50.0, 100.0, 333.0)
PAIRS = list(itertools.product(RATES, RATES))


def sent(rate, first, begin, end):
    """(time, sequence) of a publisher's messages."""
    return [(begin + k / rate, first + k) for k in range(int((end - begin) * rate))]


def after(source, messages, publishers):
    for now, sequence in messages:
        source = source.receive(sequence, publishers, now)
    return source


@pytest.mark.parametrize(('live', 'frozen'), PAIRS)
def test_no_message_counts_while_two_send(live, frozen):
    for seed in range(5):
        check_no_message_counts(live, frozen, random.Random(seed))


def check_no_message_counts(live, frozen, dice):
    source = after(SoleSource(), sent(live, dice.randrange(1, 2000), 0.0, 2.0), 1)
    begin = 2.0 + dice.uniform(0.0, 1.0 / live)
    both = [(*message, 'live') for message in sent(live, source.sequence + 1, 2.0, 4.0)]
    both += [(*message, 'frozen') for message in sent(frozen, dice.randrange(1, 2000), begin, 4.0)]
    has_begun = False
    for now, sequence, who in sorted(both):
        has_begun |= who == 'frozen'
        source = source.receive(sequence, 2 if has_begun else 1, now)
        assert source.is_mixed(now) is has_begun


@pytest.mark.parametrize(('live', 'other'), PAIRS)
def test_publisher_that_was_known_long_before_its_first_message_does_not_count(live, other):
    source = after(SoleSource(), sent(live, 1, 0.0, 1.0), 1)
    source = after(source, sent(live, source.sequence + 1, 1.0, 4.0), 2)
    assert not source.is_mixed(4.0)
    source = source.receive(1, 2, 4.001)
    assert source.is_mixed(4.001)


@pytest.mark.parametrize('rate', RATES)
@pytest.mark.parametrize('share', [0.02, 0.5, 0.95])
def test_one_publisher_may_lose_messages(rate, share):
    dice = random.Random(1)
    source = SoleSource()
    for now, sequence in sent(rate, 77, 0.0, 20.0):
        if dice.random() >= share:
            source = source.receive(sequence, 1, now)
            assert not source.is_mixed(now)


def test_few_losses_are_tolerated_while_a_dead_publisher_is_still_known():
    source = SoleSource()
    for now, sequence in sent(50.0, 9, 0.0, 20.0):
        if sequence % 7:
            source = source.receive(sequence, 2, now)
            assert not source.is_mixed(now)


@pytest.mark.parametrize('ahead', range(8))
@pytest.mark.parametrize('silence', [0.3, 1.5, 60.0])
def test_two_pads_that_began_together_are_noticed_at_the_first_message(ahead, silence):
    """With numbers alike; also after this computer stood still, when trust begins anew."""
    source = SoleSource(is_continuous=True)
    for begin in (0.0, 1.0 + silence):
        for k in range(50):
            for offset, delay in ((0, 0.0), (ahead, 0.001)):
                now = begin + 0.02 * k + delay
                source = source.receive(700 + round(50 * begin) + k + offset, 2, now)
                assert source.is_mixed(now)


def test_pad_that_was_killed_and_started_again_counts_after_a_second():
    killed = after(SoleSource(is_continuous=True), sent(50.0, 700, 0.0, 3.0), 1)
    assert not killed.is_mixed(3.0)
    for now, sequence in sent(50.0, 1, 5.0, 10.0):
        killed = killed.receive(sequence, 2, now)
        assert killed.is_mixed(now) is (now - 5.0 < QUIET)


def test_source_of_twists_that_was_killed_and_started_again_counts_at_once():
    killed = after(SoleSource(), sent(50.0, 700, 0.0, 3.0), 1)
    begin = killed.received_at + OVERLAP + 0.01
    for now, sequence in sent(50.0, 1, begin, begin + 5.0):
        killed = killed.receive(sequence, 2, now)
        assert not killed.is_mixed(now)


def test_one_counts_again_a_second_after_the_other_has_gone():
    source = after(SoleSource(), sent(50.0, 700, 0.0, 1.0), 1)
    source = source.receive(5, 2, 1.0)
    went = 1.02
    for now, sequence in sent(50.0, 750, went, 4.0):
        source = source.receive(sequence, 2, now)
        assert source.is_mixed(now) is (now - went < QUIET)


def test_without_numbers_every_known_publisher_counts_as_sending():
    source = SoleSource().receive(None, 1, 0.0).receive(None, 1, 0.02)
    assert not source.is_mixed(0.02)
    source = source.receive(None, 2, 0.04)
    assert source.is_mixed(0.04)
    assert not source.receive(None, 1, 2.0).is_mixed(2.0)
