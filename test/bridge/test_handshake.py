"""A board's clock tells whether it started again, at any of its readings."""

from itertools import product

import pytest

from bridge.handshake import has_restarted
from bridge.protocol import Hello, ResetCause

DAY = 86_400.0
WRAP = 2**32 / 1000
UPTIMES = [2.0, 60.0, DAY, 24 * DAY, 25 * DAY, 40 * DAY, WRAP - 0.2]
GAPS = [0.25, 1.0, 60.0, DAY, 24 * DAY, 25 * DAY, 49 * DAY, 51 * DAY]


def hello(uptime):
    return Hello(1, ResetCause.POWER_ON, 6, round(1000 * uptime) & 0xFFFF_FFFF)


@pytest.mark.parametrize('drift', [0.99, 1.0, 1.01])
def test_a_board_that_goes_on_has_not_restarted(drift):
    for uptime, gap in product(UPTIMES, GAPS):
        is_new = has_restarted(hello(uptime), hello(uptime + drift * gap), gap)
        assert not is_new, f'up for {uptime} s, seen again after {gap} s'


@pytest.mark.parametrize('uptime', UPTIMES[:-1])
def test_a_board_that_counts_from_nothing_has(uptime):
    assert has_restarted(hello(uptime), hello(1.5), 2.0)


@pytest.mark.parametrize('uptime', [60.0, 25 * DAY])
def test_hellos_that_waited_for_a_stalled_computer_are_no_restart(uptime):
    assert not has_restarted(hello(uptime), hello(uptime + 600.0), 0.001)
