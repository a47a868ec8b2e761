import itertools

import pytest

from bridge.fake.faults import LONGEST, FaultKind, Faults


def happenings(seed, per_minute, seconds=600, step=0.01):
    faults = Faults(seed, per_minute)
    times = [step * k for k in range(round(seconds / step))]
    return faults, [(t, *change) for t in times for change in faults.advance(t)]


def test_the_same_seed_brings_the_same_faults_and_another_one_others():
    assert happenings(7, 60)[1] == happenings(7, 60)[1]
    assert happenings(7, 60)[1] != happenings(8, 60)[1]


def test_random_faults_are_of_all_kinds_and_as_many_as_asked_for():
    faults, _ = happenings(1, 60)
    assert set(faults.counts) == set(FaultKind)
    assert faults.counts.total() == pytest.approx(600, rel=0.2)


def test_every_fault_that_begins_ends_in_its_time():
    _, changes = happenings(3, 20)
    for kind in FaultKind:
        own = [(t, begins) for t, k, begins in changes if k is kind]
        flags = [begins for _, begins in own]
        assert flags == [True, False] * (len(flags) // 2) + [True] * (len(flags) % 2)
    pairs = [(a, b) for a, b in itertools.pairwise(changes) if a[1] is b[1] and a[2]]
    assert all(b[0] - a[0] <= 2 * LONGEST[a[1]] + 0.02 for a, b in pairs)


def test_without_a_rate_nothing_happens_but_what_is_asked_for():
    faults = Faults()
    assert not any(faults.advance(0.1 * k) for k in range(1000))
    faults.inject(FaultKind.MUTE)
    assert faults.advance(100.0) == [(FaultKind.MUTE, True)]
    assert faults.active == {FaultKind.MUTE}
    assert faults.advance(100.9) == []
    assert faults.advance(101.0) == [(FaultKind.MUTE, False)]
    assert not faults.active


def test_a_fault_that_comes_again_lasts_longer():
    faults = Faults()
    faults.inject(FaultKind.MUTE)
    faults.advance(0.0)
    faults.inject(FaultKind.MUTE)
    assert faults.advance(0.8) == []
    assert faults.advance(1.2) == []
    assert faults.advance(1.8) == [(FaultKind.MUTE, False)]


def test_calm_ends_the_random_ones():
    faults = Faults(1, 600)
    for k in range(1000):
        faults.advance(0.01 * k)
    faults.calm()
    before = faults.counts.total()
    for k in range(1000, 2000):
        faults.advance(0.01 * k)
    assert faults.counts.total() == before > 50
    assert not faults.active
