"""Every script in examples/ beside the running graph."""

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Float64

from manipulator.nodes.messages import pose_of
from manipulator.nodes.qos import LATCHED

pytestmark = pytest.mark.graph
ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def poses(enabled):
    """The measured poses since the test began, as far as the user was spun."""
    received = []
    subscription = enabled.node.create_subscription(
        PoseStamped, 'pose', lambda message: received.append(pose_of(message)), 1000
    )
    enabled.wait('a pose', lambda: received)
    yield received
    enabled.node.destroy_subscription(subscription)


@pytest.fixture
def start():
    """Starts an example as a process; ends it if the test did not."""
    started = []

    def start(name, *words):
        command = [sys.executable, '-u', str(ROOT / 'examples' / f'{name}.py'), *map(str, words)]
        pipes = {'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT, 'text': True}
        # Tests that run in the background of a shell have SIGINT ignored, and so would it.
        before = signal.signal(signal.SIGINT, signal.SIG_DFL)
        started.append(subprocess.Popen(command, cwd=ROOT, **pipes))
        signal.signal(signal.SIGINT, before)
        return started[-1]

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
            process.wait()


@pytest.fixture
def run(start, enabled):
    """What an example prints until its good end; again where the machine was lost meanwhile."""

    def run(*words):
        def once():
            status, said = enabled.end_of(start(*words))
            assert status == 0, said
            return said

        return enabled.persist(once)

    return run


def test_the_tour_of_twenty_lines_moves_measures_is_refused_jogs_and_stops(run, poses, enabled):
    assert len((ROOT / 'examples' / 'tour.py').read_text().splitlines()) <= 20

    def tour():
        measured, refused = run('tour').split('refused: ')
        assert measured.count('measured') == 3
        assert refused.startswith('leg '), refused
        assert 'rod too short by' in refused

    enabled.persist(tour)
    x, y, _ = np.transpose([pose.position for pose in poses])
    assert abs(np.hypot(x, y) - 0.008).min() < 2e-4


def test_the_circle_is_drawn_in_all_four_quadrants(run, poses):
    poses.clear()
    assert 'mm from the circle' in run('draw_circle')
    x, y, _ = np.transpose([pose.position for pose in poses])
    on_circle = abs(np.hypot(x, y) - 0.008) < 5e-4
    assert {(a > 0, b > 0) for a, b in zip(x[on_circle], y[on_circle], strict=True)} == {
        (False, False), (False, True), (True, False), (True, True)
    }  # fmt: skip


def test_axis_tour_visits_both_sides_of_every_axis(run):
    rows = [line.replace(',', '').split() for line in run('axis_tour').splitlines()]
    assert [row[0] for row in rows[::3]] == ['x', 'y', 'z', 'roll', 'pitch', 'yaw']
    asked, measured = np.array([(float(row[1]), float(row[4])) for row in rows]).T
    way = np.repeat([0.004, 0.07], 9)
    np.testing.assert_allclose(asked / way, np.tile([1.0, -1.0, 0.0], 6))
    np.testing.assert_allclose(measured / way, asked / way, atol=0.07)


def test_async_moves_report_their_progress(run):
    shares = [int(line.rstrip('%')) for line in run('async_moves').splitlines()]
    assert shares.count(100) >= 3
    assert all(0 <= share <= 100 for share in shares)


def test_watch_joints_prints_names_and_radians_until_ctrl_c(start, enabled):
    def go():
        enabled.reach_home()
        process = start('watch_joints')
        lines = [process.stdout.readline() for _ in range(4)]
        process.send_signal(signal.SIGINT)
        status, said = enabled.end_of(process)
        assert (status, 'Traceback' in said) == (0, False), (lines, said)
        assert lines[0].split()[:6] == [f'crank_{leg}' for leg in range(1, 7)]
        joints = [float(word) for word in lines[3].split()[:6]]
        assert joints == pytest.approx([2.0945] * 6, abs=0.01)

    enabled.persist(go)


def test_stop_ends_the_motion_of_another_program(start, enabled):
    override = enabled.node.create_publisher(Float64, 'speed_override', LATCHED)
    enabled.wait('a subscriber', override.get_subscription_count, 10.0)

    def stop_on_tour():
        override.publish(Float64(data=0.05))
        tour = start('axis_tour')
        if not (first := tour.stdout.readline()).startswith('x +'):
            raise AssertionError(first + enabled.end_of(tour)[1])
        override.publish(Float64(data=0.002))  # its next move lasts until `stop` comes
        assert enabled.end_of(start('stop')) == (0, 'enabled\n')
        status, said = enabled.end_of(tour)
        assert status == 1, said
        assert 'manipulator.errors.Stopped' in said

    try:
        enabled.persist(stop_on_tour)
    finally:
        override.publish(Float64(data=1.0))
        override.wait_for_all_acked()
        enabled.node.destroy_publisher(override)


def test_emergency_stop_holds_until_it_is_cleared(start, enabled, run):
    def stop():
        assert enabled.end_of(start('stop', '--emergency')) == (0, 'stopped\n')
        enabled.wait_for_state('stopped')
        status, said = enabled.end_of(start('axis_tour'))
        assert status == 1
        assert 'Refused: serial_bridge/enable: the board is stopped: clear the stop first' in said
        enabled.trigger('serial_bridge/clear_fault')

    enabled.persist(stop)
    run('tour')
