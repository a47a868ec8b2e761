"""The watch on the computer itself: a process that is frozen cannot tell a freeze of its core."""

import signal
import time

import pytest

from bench.stall_watch import StallWatch


@pytest.mark.processes
def test_a_core_that_was_away_is_reported_and_only_since_then():
    with StallWatch() as watch:
        deadline = time.monotonic() + 60.0
        while watch.longest() < 0.3 and time.monotonic() < deadline:  # it may still be starting
            watch.process.send_signal(signal.SIGSTOP)
            time.sleep(0.4)
            watch.process.send_signal(signal.SIGCONT)
            time.sleep(0.2)
        assert 0.3 < watch.longest() < 60.0
        assert watch.summary == f'{watch.longest():.1f} s'
        assert watch.longest(since=time.monotonic()) == 0.0


def test_a_computer_that_went_on_has_nothing_to_report():
    assert StallWatch().summary == 'less than 0.1 s'
