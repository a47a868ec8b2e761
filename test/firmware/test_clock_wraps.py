"""A board that runs for months: its clocks wrap after 71 minutes, 49.7 days and 2.7 years."""

import numpy as np
import pytest

from bridge.protocol import Arm, Disarm, Fault, FaultCode, Hello, Mode, Setpoint, State
from firmware.simulator.chip import CLOCK_HZ
from firmware.simulator.uptime import MS_WRAP, PERIODS_WRAP, US_WRAP, put_forward

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
DAY = 24 * 3600 * 50
WRAPS = {
    '36 minutes': US_WRAP // 2,
    '72 minutes': US_WRAP,
    '24.9 days': MS_WRAP // 2,
    '49.7 days': MS_WRAP,
    '2.7 years': PERIODS_WRAP,
}
"""In pulse periods: where a time changes its sign, and where it begins again."""


@pytest.fixture(params=WRAPS)
def before(request, host):
    """Takes a board to so many periods before the wrap, with a host that was never silent."""

    def go(periods):
        left = WRAPS[request.param] - periods - round(50 * host.chip.seconds)
        while left > 0:
            put_forward(host.board, min(left, 10 * DAY))
            left -= 10 * DAY
            host.ask(Disarm())
        return host

    host.run(0.1)
    return go


def when(host, seconds, kind):
    """Times of the messages of a kind, in seconds from now."""
    start = host.chip.seconds
    found = []
    while host.chip.seconds < start + seconds:
        found += [host.chip.seconds - start for m in host.run(0.005) if isinstance(m, kind)]
    return found


@pytest.mark.parametrize('days', [20, 40, 60])
def test_a_host_that_falls_silent_after_weeks_is_greeted(host, days):
    host.run(0.1)
    for _ in range(days // 10):
        put_forward(host.board, 10 * DAY)
        host.ask(Disarm())
    greetings = when(host, 2.0, Hello)
    assert greetings[0] == pytest.approx(0.46, abs=0.06)
    assert np.diff(greetings) == pytest.approx(0.26, abs=0.02)


def test_a_host_that_was_never_there_is_greeted_after_49_days_as_before(host):
    host.run(0.1)
    for left in (10 * DAY, 10 * DAY, 10 * DAY, 10 * DAY, MS_WRAP - 40 * DAY - 300):
        put_forward(host.board, left)
        host.run(1.0)
    assert np.diff(when(host, 4.0, Hello)) == pytest.approx(0.26, abs=0.02)


def test_a_silent_host_is_greeted_over_every_wrap(before):
    host = before(100)
    assert np.diff(when(host, 4.0, Hello)) == pytest.approx(0.26, abs=0.02)


def test_servos_are_energised_one_by_one_over_every_wrap(before):
    host = before(4)
    host.chip.edges()
    host.ask(Arm(PARK))
    host.run(0.3)
    edges = host.chip.edges()
    first = [int(edges[edges['channel'] == k]['cycle'][0]) for k in range(6)]
    assert np.diff(first) / CLOCK_HZ == pytest.approx([0.02] * 5, abs=0.001)
    assert host.state().mode is Mode.ARMED


def test_a_deadline_is_kept_over_every_wrap(before):
    host = before(50)
    host.arm()
    start = host.chip.seconds
    while host.chip.seconds < start + 1.5:
        host.send(Setpoint(100, PARK))
        messages = host.run(0.08)
        assert {m.mode for m in messages if isinstance(m, State)} == {Mode.ARMED}
    host.send(Setpoint(100, PARK))
    held = [m.mode for m in host.run(0.2) if isinstance(m, State)].index(Mode.HOLDING)
    assert held in (5, 6)


def test_a_low_battery_has_half_a_second_over_every_wrap(before):
    host = before(30)
    host.arm()
    host.send(Setpoint(2000, PARK))
    host.board.battery_mv = 5900
    start = host.chip.seconds
    while FaultCode.UNDERVOLTAGE not in [m.code for m in host.run(0.02) if isinstance(m, Fault)]:
        assert host.chip.seconds < start + 0.6
    assert host.chip.seconds - start == pytest.approx(0.52, abs=0.03)
