"""What the line carries, and what garbage does to it."""

import random
from itertools import pairwise

import pytest

from bridge.protocol import Flag, Hello, Mode, Setpoint, State
from firmware.simulator.chip import CLOCK_HZ
from firmware.simulator.fuzz import fuzz, mutants

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
FAR = (4800, 1200, 4800, 1200, 4800, 1200)


@pytest.mark.parametrize('rate', [400, 800])
def test_no_setpoint_is_lost_at_250000_baud(armed, rate):
    for k in range(3 * rate):
        armed.send(Setpoint(200, tuple(count + k % 100 for count in PARK)))
        armed.run(1 / rate)
    state = armed.state()
    assert state.echo == armed.sequence
    assert (state.refused, state.bad_frames, state.overruns) == (0, 0, 0)
    assert tuple(joint.count for joint in state.joints) == tuple(count + 99 for count in PARK)
    assert armed.chip.lost_bytes == 0


@pytest.mark.parametrize('deadline_ms', [20, 200])
def test_link_loss_is_held_within_the_deadline_and_one_period(armed, deadline_ms):
    armed.send(Setpoint(deadline_ms, FAR))
    silent_from = armed.chip.cycle
    while armed.last_state.mode is not Mode.HOLDING:
        armed.run(0.001)
        assert armed.chip.cycle - silent_from < (deadline_ms + 25) * CLOCK_HZ // 1000
    there = armed.last_state.joints
    assert Flag.DEADLINE_PASSED in armed.last_state.flags
    armed.run(1.0)
    assert armed.state().joints == there


def test_the_line_is_the_one_that_the_header_asks_for(host):
    host.run(0.1)
    ubrr, double_speed = host.chip.peek(0xC4), host.chip.peek(0xC0) & 2
    assert (ubrr, double_speed) == (16_000_000 // 8 // 250_000 - 1, 2)


def test_uptime_counts_milliseconds(host):
    host.run(0.1)
    host.run(2.0)
    hello = next(m for m in host.run(0.3) if isinstance(m, Hello))
    assert hello.uptime_ms == pytest.approx(1000 * host.chip.cycle / CLOCK_HZ, abs=320)


def test_echo_age_is_exact_and_saturates(armed):
    armed.send(Setpoint(2000, PARK))
    ages = [m.echo_age_us for m in armed.run(0.08) if isinstance(m, State)][1:]
    assert {b - a for a, b in pairwise(ages)} == {20_000}
    armed.run(0.1)
    assert armed.state().echo_age_us == 65535


def test_random_and_mutated_frames_move_nothing_and_never_stall_the_link(armed):
    assert fuzz(armed, seed=11, size=500_000) >= 500_000


def test_random_and_mutated_frames_arm_nothing(host):
    host.run(0.1)
    rng = random.Random(5)
    for _ in range(10):
        host.board.feed(b''.join(mutants(rng, 100)))
        while host.board.backlog:
            host.run(0.02)
    assert host.state().mode is Mode.DISARMED
    assert len(host.chip.edges()) == 0
