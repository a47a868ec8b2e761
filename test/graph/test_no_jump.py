"""No jump, asserted on the frames and on the pulses that they become."""

import itertools
import time

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped
from std_msgs.msg import Bool, Float64
from std_srvs.srv import SetBool

from bridge.messages import Clear, Setpoint, Stop
from hexarm.rig import Rig
from manipulator.nodes.qos import COMMAND

pytestmark = pytest.mark.graph

QUIET = 2
"""Counts: roundings, not motion."""


@pytest.fixture(scope='module')
def module_rig(tmp_path_factory, tolerant_robocake):
    folder = tmp_path_factory.mktemp('jumps')
    with Rig(folder, 'no_jump', machine=tolerant_robocake) as rig:
        rig.enable()
        yield rig


@pytest.fixture
def rig(module_rig):
    """At home, at rest, at full speed, whatever the last test left."""
    if module_rig.user.machine_state.message != 'enabled':
        module_rig.user.trigger('serial_bridge/clear_fault')
        module_rig.enable()
    module_rig.user.wait('goals', lambda: module_rig.user.motion('mode') == 'hold', 10.0)
    module_rig.user.home()
    module_rig.user.spin(0.2)
    return module_rig


def publisher(rig, kind, topic):
    made = rig.user.node.create_publisher(kind, topic, COMMAND)
    rig.user.wait('a listener', lambda: made.get_subscription_count() > 0, 10.0)
    return made


def steps(rig, since):
    """The largest change of a count from each frame to the next."""
    counts = [np.array(m.counts) for _, m in rig.tap.heard(Setpoint, since)]
    return [float(np.abs(b - a).max()) for a, b in itertools.pairwise(counts)]


def test_after_stop_and_clear_nothing_moves_until_a_new_command(rig):
    stops = publisher(rig, Bool, 'emergency_stop')
    rig.circle(0.7)
    stops.publish(Bool(data=True))
    rig.user.wait('stopped', lambda: rig.user.machine_state.message == 'stopped', 5.0)
    stopped = rig.tap.heard(Stop)[-1][0]
    still = rig.recorder.standstill(stopped, 0.5)
    said = [type(message) for _, message in rig.tap.heard(since=stopped)]
    assert Setpoint not in said[said.index(Stop) :]
    rig.user.wait('the drop', lambda: rig.user.motion('result') == 'stopped', 5.0)
    rig.user.trigger('serial_bridge/clear_fault')
    rig.user.wait('goals', lambda: rig.user.motion('mode') == 'hold', 10.0)
    rig.user.spin(0.5)
    assert rig.recorder.way(still + 0.05) <= QUIET
    assert max(steps(rig, stopped)) <= QUIET


def test_a_hammered_stop_holds_and_only_the_service_clears(rig):
    stops = publisher(rig, Bool, 'emergency_stop')
    rig.circle(0.7)
    for k in range(200):
        stops.publish(Bool(data=k % 2 == 0))
        rig.user.spin(0.002)
    rig.user.wait('stopped', lambda: rig.user.machine_state.message == 'stopped', 5.0)
    since = time.monotonic()
    stops.publish(Bool(data=False))
    rig.user.spin(0.5)
    assert rig.user.machine_state.message == 'stopped'
    assert rig.recorder.way(since) <= QUIET
    assert not rig.tap.heard((Clear, Setpoint), since)
    rig.user.trigger('serial_bridge/clear_fault')


def slow_down_pause_and_go_on(rig, overrides):
    """On the circle; asserts that no frame is far from the one before."""
    begin = time.monotonic()
    rig.circle(0.7)
    usual = max(steps(rig, begin))
    since = time.monotonic()
    for rate in (0.0, 1.0, 0.2, 1.0):
        overrides.publish(Float64(data=rate))
        rig.user.spin(0.3)
    for is_paused in (True, False):
        rig.user._call(SetBool, 'trajectory/pause', SetBool.Request(data=is_paused))
        rig.user.spin(0.4)
    # A frame that came late is followed by one that comes twice as far.
    assert max(steps(rig, since)) <= 2 * usual + QUIET


def test_pause_speed_override_and_a_new_pivot_change_nothing_suddenly(rig):
    overrides = publisher(rig, Float64, 'speed_override')
    for _ in range(3):
        slow_down_pause_and_go_on(rig, overrides)
        if rig.user.motion('mode') == 'cycle':
            break  # else the computer stood still, and the machine stopped, as it should
    assert rig.user.motion('mode') == 'cycle'
    rig.user.trigger('trajectory/stop')
    rig.user.wait('rest', lambda: rig.user.motion('result') == 'stopped', 5.0)
    rig.user.spin(0.3)
    since = time.monotonic()
    pivot = PointStamped()
    pivot.point.z = 0.05
    pivots = publisher(rig, PointStamped, 'pivot')
    for z in (0.05, 0.0):
        pivot.point.z = z
        pivots.publish(pivot)
        rig.user.spin(0.3)
    assert rig.recorder.way(since) <= QUIET


def test_after_holding_in_motion_the_machine_stands_until_a_new_goal(rig):
    rig.circle(0.7)
    pulled = rig.pull()
    still = rig.recorder.standstill(pulled, 0.5)
    rig.plug()
    rig.user.wait('disarmed', lambda: rig.user.machine_state.message == 'disarmed', 10.0)
    rig.user.spin(0.5)
    assert not rig.tap.heard(Setpoint, still)
    rig.enable()
    rig.user.spin(0.3)
    park = np.array(rig.calibration.counts(rig.calibration.park))
    frames = [np.array(m.counts) for _, m in rig.tap.heard(Setpoint, still)]
    assert np.abs(frames - park).max() <= QUIET
    rig.circle(0.3)
