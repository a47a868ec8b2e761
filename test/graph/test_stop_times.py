"""Every process killed and frozen, and a stop, while the platform circles: nothing jumps.

Judged on the frames and on the pulses that they become; how soon, bench/stop_times.py measures.
"""

import contextlib
import signal
import time

import numpy as np
import pytest
from std_msgs.msg import Bool

from bridge.protocol import Setpoint, Stop
from manipulator.errors import Refused, TimedOut
from manipulator.nodes.qos import EVERY_WORD
from rig import Rig

pytestmark = pytest.mark.graph

PROCESSES = ('serial_bridge', 'ik', 'pose', 'trajectory')
PATIENCE = 60.0
TRIES, SOON = 10, 10.0
"""After how many seconds a machine that was lost meanwhile is enabled again."""
QUIET = 2
"""Counts by which a pulse may change when a process comes back: roundings, not motion."""


@pytest.fixture(scope='module')
def module_rig(tmp_path_factory, tolerant_robocake):
    folder = tmp_path_factory.mktemp('stops')
    with Rig(folder, 'stop_times', machine=tolerant_robocake) as rig:
        assert set(rig.names) == set(PROCESSES)
        rig.enable()
        rig.circle(1.0)
        yield rig


@pytest.fixture
def circling(module_rig):
    """The platform on its circle, its servos moving."""
    for _ in range(TRIES):
        module_rig.circle(0.7)
        if module_rig.recorder.largest_step(module_rig.tap.frames(Setpoint)[-60][0]) > 5:
            return module_rig
    raise AssertionError(f'it never moved: {module_rig.user.summary}')


def make_ready(rig):
    """Enabled and standing; asked for as a user would, where a stall had the board forgotten."""
    for _ in range(TRIES):
        rig.enable()
        with contextlib.suppress(TimedOut):
            return rig.user.wait('goals', lambda: rig.user.motion('mode') == 'hold', SOON)
    raise TimedOut(f'not ready in {TRIES} tries: {rig.user.summary}')


def clear(rig):
    """As `make_ready`."""
    for _ in range(TRIES):
        with contextlib.suppress(Refused, TimedOut):
            return rig.user.trigger('serial_bridge/clear_fault')
        rig.user.spin(1.0)
    raise TimedOut(f'not cleared in {TRIES} tries: {rig.user.summary}')


def check_that_it_drives_again(rig):
    """Home and onto the circle again, never faster than the servos."""
    since = rig.tap.frames()[-1][0]
    rig.circle(0.3)
    assert 0 < rig.recorder.largest_step(since) <= rig.recorder.slew


@pytest.mark.parametrize('name', PROCESSES)
def test_a_frozen_process_stops_the_machine_and_nothing_jumps_when_it_goes_on(circling, name):
    rig = circling
    rig.stop_time(name, signal.SIGSTOP)
    resumed = rig.send(name, signal.SIGCONT)
    rig.user.spin(1.0)
    make_ready(rig)
    assert rig.recorder.way(resumed) <= QUIET
    check_that_it_drives_again(rig)


@pytest.mark.parametrize('name', PROCESSES)
def test_a_killed_process_stops_the_machine_and_nothing_jumps_when_it_is_started_again(
    circling, name
):
    rig = circling
    rig.stop_time(name, signal.SIGKILL)
    before = time.monotonic()
    rig.start(name)
    rig.user.spin(1.5)
    if name == 'serial_bridge':
        rig.user.wait('word', lambda: rig.user.machine_state.message == 'unclaimed', PATIENCE)
        assert not rig.tap.frames(Setpoint, before)
    make_ready(rig)
    assert rig.recorder.way(before) <= QUIET
    check_that_it_drives_again(rig)


def test_after_stop_and_clear_nothing_moves_until_a_new_command(circling):
    rig = circling
    stops = rig.user.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
    rig.user.wait('a listener', lambda: stops.get_subscription_count() > 0, PATIENCE)
    begin = time.monotonic()
    stops.publish(Bool(data=True))
    rig.user.wait('stopped', lambda: rig.user.machine_state.message == 'stopped', PATIENCE)
    still = rig.recorder.standstill(rig.tap.frames(Stop, begin)[-1][0], 0.5)
    assert setpoints_after_stop(rig, begin) == []
    clear(rig)
    make_ready(rig)
    rig.user.spin(0.5)
    assert rig.recorder.way(still + 0.05) <= QUIET
    assert np.ptp(setpoints_after_stop(rig, begin), axis=0).max() <= QUIET
    check_that_it_drives_again(rig)


def setpoints_after_stop(rig, begin):
    """Counts of each setpoint behind the last STOP; one read may bring both, at one time."""
    text = [message for _, message in rig.tap.frames((Setpoint, Stop), begin)]
    last_stop = max(k for k, message in enumerate(text) if isinstance(message, Stop))
    return [message.counts for message in text[last_stop + 1 :]]
