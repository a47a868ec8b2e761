"""Every process killed and frozen while the platform circles: it stands still, nothing jumps."""

import signal
import time

import pytest

from bridge.messages import Setpoint
from hexarm.rig import Rig

pytestmark = pytest.mark.graph

PROCESSES = ('serial_bridge', 'ik', 'pose', 'trajectory')
GENEROUS = 2.0
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
    module_rig.circle(0.7)
    assert module_rig.recorder.largest_step(module_rig.tap.heard(Setpoint)[-60][0]) > 5
    return module_rig


def check_that_it_drives_again(rig):
    """Home and onto the circle again, never faster than the servos."""
    since = rig.tap.heard()[-1][0]
    rig.circle(0.3)
    assert 0 < rig.recorder.largest_step(since) <= rig.recorder.slew


def is_enabled(rig):
    return rig.user.machine_state.message == 'enabled'


@pytest.mark.parametrize('name', PROCESSES)
def test_a_frozen_process_stops_the_machine_and_nothing_jumps_when_it_goes_on(circling, name):
    rig = circling
    assert rig.stop_time(name, signal.SIGSTOP) < GENEROUS
    resumed = rig.send(name, signal.SIGCONT)
    rig.user.spin(1.0)
    rig.user.wait('the machine enabled again', lambda: is_enabled(rig), 10.0)
    assert rig.recorder.way(resumed) <= QUIET
    check_that_it_drives_again(rig)


@pytest.mark.parametrize('name', PROCESSES)
def test_a_killed_process_stops_the_machine_and_nothing_jumps_when_it_is_started_again(
    circling, name
):
    rig = circling
    assert rig.stop_time(name, signal.SIGKILL) < GENEROUS
    before = time.monotonic()
    rig.start(name)
    rig.user.spin(1.5)
    if name == 'serial_bridge':
        rig.user.wait('word', lambda: rig.user.machine_state.message == 'unclaimed', 10.0)
        assert not rig.tap.heard(Setpoint, before)
        rig.enable()
    assert rig.recorder.way(before) <= QUIET
    check_that_it_drives_again(rig)
