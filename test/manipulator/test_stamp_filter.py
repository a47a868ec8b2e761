import pytest

from manipulator.message_filter import StaleMessage, StampFilter


def test_messages_in_order_are_admitted():
    stamps = StampFilter()
    for k in range(10):
        stamps.admit(100.0 + k, 100.001 + k)


def test_reordered_message_is_stale():
    stamps = StampFilter()
    stamps.admit(100.2, 100.2)
    with pytest.raises(StaleMessage, match='reordered'):
        stamps.admit(100.1, 100.21)


def test_message_that_queued_up_is_stale_and_the_next_fresh_one_is_not():
    stamps = StampFilter()
    stamps.admit(100.0, 100.0)
    with pytest.raises(StaleMessage, match='old, at most'):
        stamps.admit(100.1, 102.0)
    stamps.admit(102.0, 102.0)


@pytest.mark.parametrize('offset', [3600.0, -3600.0])
def test_source_whose_clock_is_off_by_an_hour_is_understood(offset):
    stamps = StampFilter()
    for k in range(5):
        stamps.admit(offset + 100.0 + k, 100.0 + k)
    assert stamps.offset == pytest.approx(-offset)
    with pytest.raises(StaleMessage, match='old'):
        stamps.admit(offset + 105.0, 107.0)


def test_clock_set_back_is_believed_with_the_second_message():
    stamps = StampFilter()
    stamps.admit(5000.0, 100.0)
    with pytest.raises(StaleMessage, match='the clock of the source was set'):
        stamps.admit(101.0, 101.0)
    stamps.admit(102.0, 102.0)
    stamps.admit(103.0, 103.0)


def test_what_piled_up_while_the_receiver_was_frozen_is_no_clock_that_was_set():
    stamps = StampFilter()
    stamps.admit(100.0, 100.0)
    for k in range(50):
        with pytest.raises(StaleMessage):
            stamps.admit(100.01 + 0.01 * k, 101.01 + 0.0005 * k)
    stamps.admit(101.03, 101.035)


def test_one_message_from_long_ago_is_refused_and_forgotten():
    stamps = StampFilter()
    stamps.admit(5000.0, 5000.0)
    with pytest.raises(StaleMessage):
        stamps.admit(100.0, 5001.0)
    stamps.admit(5002.0, 5002.0)
    with pytest.raises(StaleMessage):
        stamps.admit(200.0, 5003.0)


def test_clock_that_went_back_between_rare_messages_is_learnt_with_the_second():
    stamps = StampFilter()
    stamps.admit(100.0, 100.0)
    with pytest.raises(StaleMessage):
        stamps.admit(130.0, 160.0)
    stamps.admit(190.0, 220.0)


def test_late_messages_whose_offsets_do_not_agree_indicate_no_clock():
    stamps = StampFilter()
    stamps.admit(100.0, 100.0)
    for stamp, receipt in ((101.0, 110.0), (101.2, 111.0), (101.4, 112.0)):
        with pytest.raises(StaleMessage, match='old'):
            stamps.admit(stamp, receipt)
    stamps.admit(113.0, 113.0)


def test_first_message_that_came_late_does_not_hide_later_lateness():
    stamps = StampFilter()
    stamps.admit(100.0, 100.4)
    stamps.admit(100.5, 100.5)
    with pytest.raises(StaleMessage, match='old'):
        stamps.admit(100.6, 101.2)
