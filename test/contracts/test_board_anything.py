"""Whatever a host says in good frames, the pulses stay in range and no servo is outrun."""

import math
import random
import struct

import pytest

from bridge.protocol import (
    Ack,
    Arm,
    Clear,
    CycleAxis,
    Disarm,
    Fault,
    Finish,
    Play,
    Setpoint,
    State,
    Stop,
    TableBegin,
    TableEnd,
    TableRow,
)

PARK = (3000, 2900, 3100, 3000, 2900, 3100)
LOW, HIGH, STEP = 1100, 4900, 252
EDGES = (0, 1, 1099, 1100, 2000, 3000, 4000, 4900, 4901, 40_000, 65_535)
WITHIN = 0.17
"""Seconds a message is given; no deadline and no arming ends just then: phases do not matter."""
FLOATS = (0.0, 0.002, -0.002, 0.06, 1e9, math.inf, -math.inf, math.nan, 1e-40)


def counts(rng):
    """Mostly good ones, near or far; some out of range, some too many."""
    kind = rng.random()
    if kind < 0.6:
        return tuple(rng.randint(LOW, HIGH) for _ in range(6))
    if kind < 0.85:
        return tuple(count + rng.randint(-60, 60) for count in PARK)
    return tuple(rng.choice(EDGES) for _ in range(rng.choice([1, 5, 6, 6, 6, 7, 8])))


def anything(rng):
    """A message with any values that its frame can carry."""
    u16 = rng.choice([*EDGES, rng.randrange(65_536)])
    return rng.choice(
        [
            Setpoint(rng.choice([0, 1, 20, 200, 2000, 2001]), counts(rng)),
            Setpoint(200, counts(rng)),
            Setpoint(200, counts(rng)),
            Arm(rng.choice([PARK, PARK, counts(rng)])),
            Arm(PARK),
            rng.choice([Disarm(), Stop(), Clear(), Clear()]),
            Clear(),
            CycleAxis(
                rng.choice([0, 1, 2, 5, 6, 255]),
                struct.unpack('<f', struct.pack('<f', rng.choice(FLOATS)))[0],
                rng.choice([0, 1, 500, 1000, 25_000, 25_001]),
                rng.choice(FLOATS),
            ),
            TableBegin(rng.choice([0, 1, 2, 3, 448, 449, u16]), rng.choice([0, 19, 20, 100])),
            TableRow(rng.choice([0, 0, 1, 2, u16]), counts(rng)),
            TableEnd(u16),
            Play(rng.choice([0, 1, 2, 3, 255]), rng.random() < 0.5),
            Finish(),
        ]
    )


@pytest.mark.parametrize('seed', range(4))
def test_no_pulse_is_out_of_range_and_no_servo_is_outrun(make_driver, seed):
    rng, driver = random.Random(seed), make_driver(arm_interval_us=20_000)
    driver.run(0.4)
    before, moved = driver.board.pulses, 0
    for _ in range(400):
        message = anything(rng)
        driver.send(message)
        # Released servos are seen to be so before another ARM puts them elsewhere.
        is_release = isinstance(message, Disarm | Clear)
        driver.run(0.06 if is_release else rng.choice([0.005, 0.02, 0.06]))
        after = driver.board.pulses
        for now, last in zip(after, before, strict=True):
            assert now is None or LOW <= now <= HIGH
            if now is not None and last is not None:
                assert abs(now - last) <= 5 * STEP
                moved += now != last
        before = after
    assert moved > 50
    driver.send(Clear())
    assert driver.state().joints


def answers_of(driver, seed):
    """What the board says to a hundred messages, and the mode that each leaves it in."""
    rng = random.Random(seed)
    driver.run(0.4)
    found = []
    for _ in range(100):
        message = anything(rng)
        driver.send(message)
        heard = driver.run(WITHIN)
        answers = [m.result for m in heard if isinstance(m, Ack)]
        faults = [m for m in heard if isinstance(m, Fault)]
        modes = [m.mode for m in heard if isinstance(m, State)]
        found.append((message, answers, faults, modes[-1]))
    return found


@pytest.mark.parametrize('seed', range(6))
def test_computer_and_chip_answer_alike(make_both, seed):
    computer, chip = (answers_of(driver, seed) for driver in make_both(arm_interval_us=20_000))
    for ours, theirs in zip(computer, chip, strict=True):
        assert ours[1:] == theirs[1:], f'after {ours[0]}'
