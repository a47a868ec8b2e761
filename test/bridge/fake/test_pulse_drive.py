import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bridge.fake.pulse_drive import PulseDrive

SPEEDS = (1000.0, 2000.0, 500.0)
TARGETS = st.tuples(*[st.integers(1000, 5000)] * 3)


def energised(start=(3000, 3000, 3000)):
    drive = PulseDrive(SPEEDS)
    for channel, count in enumerate(start):
        drive.energise(channel, count)
    return drive


def test_nothing_goes_out_before_a_channel_is_energised():
    drive = PulseDrive(SPEEDS)
    assert drive.pulses == (None, None, None)
    drive.energise(1, 3000)
    drive.advance(0.02)
    assert drive.pulses == (None, 3000.0, None)
    assert not drive.is_all_on


@settings(deadline=None)
@given(TARGETS, TARGETS)
def test_all_channels_move_by_one_factor_and_none_above_its_speed(start, target):
    drive = energised(start)
    drive.aim(target)
    a, b = np.array(start, float), np.array(target, float)
    for _ in range(500):
        before = np.array(drive.pulses)
        drive.advance(0.02)
        after = np.array(drive.pulses)
        assert np.all(np.abs(after - before) <= np.array(SPEEDS) * 0.02 + 1e-9)
        progress = [(p - x) / (y - x) for p, x, y in zip(after, a, b, strict=True) if x != y]
        assert progress == pytest.approx([progress[0]] * len(progress)) if progress else True
    assert drive.pulses == tuple(b)
    assert not drive.is_slewing


def test_halt_stays_where_the_pulses_are():
    drive = energised()
    drive.aim((4000, 3000, 3000))
    drive.advance(0.02)
    drive.halt()
    drive.advance(0.02)
    assert drive.pulses == (3020.0, 3000.0, 3000.0)


def test_release_ends_all_pulses():
    drive = energised()
    drive.release()
    assert drive.pulses == (None, None, None)
