"""The servo pins, edge by edge, in clock cycles: 8 are half a microsecond."""

import random

import numpy as np
import pytest

from bridge.frames import encode
from bridge.protocol import Disarm, Setpoint, Stop

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
COUNT = 8
PERIOD = 320_000
NEAR = tuple(count + 200 for count in PARK)


def test_sixty_seconds_of_traffic_move_no_edge_by_more_than_half_a_microsecond(armed):
    rng = random.Random(3)
    widths, periods, last = [], [], None
    for k in range(6000):
        armed.send(Setpoint(200, PARK))
        if k % 5 == 0:
            armed.board.feed(rng.randbytes(rng.randrange(30)))
        armed.run(rng.uniform(0.005, 0.015))
        if k % 500 == 499:
            rises, width = armed.pulses()
            widths.append(width)
            rises = rises if last is None else np.vstack([last, rises])
            periods.append(np.diff(rises, axis=0))
            last = rises[-1:]
    widths, periods = np.concatenate(widths), np.concatenate(periods)
    assert len(widths) >= 50 * 55
    assert np.abs(widths - COUNT * np.array(PARK)).max() <= COUNT
    assert np.abs(periods - PERIOD).max() <= COUNT
    assert armed.state().refused < 50


def phases():
    """Half microseconds within a period: all of it, and each single one around the latch."""
    return [*range(0, 40_000, 250), *range(37_900, 38_100, 2), *range(39_990, 40_010)]


def test_a_setpoint_at_any_phase_makes_only_whole_pulses_of_one_setpoint(armed):
    choices = (NEAR, PARK)
    frame_counts = 2 * 40 * len(encode(Setpoint(200, PARK), 5))
    for k, phase in enumerate(phases()):
        armed.run_to_phase((phase - frame_counts) % 40_000)
        armed.send(Setpoint(1000, choices[k % 2]))
        armed.run(0.025)
        sent = armed.pulse_counts()
        assert set(sent) <= set(choices), f'at phase {phase}'
        assert sent[-1] == choices[k % 2]


@pytest.mark.parametrize('phase', [0, 500, 1499, 2900, 3001, 20_000, 37_999, 38_001, 39_999])
def test_switching_off_cuts_no_pulse_short(armed, phase):
    armed.run_to_phase(phase)
    armed.send(Disarm())
    armed.run(0.1)
    assert set(armed.pulse_counts()) == {PARK}
    assert armed.board.pulses == (None,) * 6


def test_no_pulse_comes_at_power_up_or_after_any_reset(host):
    for cause in (1, 2, 4, 8):
        host.board.reset(cause)
        host.run(1.0)
        assert len(host.chip.edges()) == 0


def test_a_stop_frame_holds_the_pulses_within_one_period(armed):
    armed.send(Setpoint(1000, (4800,) * 6))
    armed.run(0.05)
    armed.pulses()
    asked = armed.chip.cycle
    armed.send(Stop())
    armed.run(0.3)
    rises, widths = armed.pulses()
    counts = np.rint(widths / COUNT)  # the simulation is exact to a few cycles
    changes = np.flatnonzero(np.any(np.diff(counts, axis=0), axis=1)) + 1
    last_change = rises[changes[-1], 0] if len(changes) else 0
    assert last_change - asked < PERIOD
