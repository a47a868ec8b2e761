"""Every script in examples/ beside the running graph."""

import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Float64

from manipulator.errors import TimedOut
from manipulator.nodes.messages import pose_of
from manipulator.nodes.qos import LATCHED
from manipulator.pose import Pose

pytestmark = pytest.mark.graph
ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def client(enabled):
    return enabled


@pytest.fixture
def poses(client):
    """The measured poses since the test began, as far as the client was spun."""
    received = []
    subscription = client.node.create_subscription(
        PoseStamped, 'pose', lambda message: received.append(pose_of(message)), 1000
    )
    client.wait('a pose', lambda: received)
    yield received
    client.node.destroy_subscription(subscription)


@pytest.fixture
def measured_now(client):
    """Hears poses from now on, when the servos have had their time, and returns the latest."""

    def measured_now():
        client.spin(0.3)
        received = []
        subscription = client.node.create_subscription(PoseStamped, 'pose', received.append, 1)
        client.wait('a pose', lambda: len(received) > 3)
        client.node.destroy_subscription(subscription)
        return pose_of(received[-1])

    return measured_now


@pytest.fixture
def start():
    """Starts an example as a process; ends it if the test did not."""
    started = []

    def start(name, *words):
        command = [sys.executable, str(ROOT / 'examples' / f'{name}.py'), *map(str, words)]
        pipes = {'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT, 'text': True}
        started.append(subprocess.Popen(command, cwd=ROOT, **pipes))
        return started[-1]

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
            process.wait()


@pytest.fixture
def end(client):
    """Exit status of a process, and what was printed."""
    return client.end_of


@pytest.fixture
def reaches(client, start, end):
    """Runs an example until it says that the goal is reached; again where the machine was lost."""

    def reaches(*words):
        def run():
            status, said = end(start(*words))
            assert (status, said) == (0, 'reached\n')

        client.persist(run)

    return reaches


def test_publish_pose_ends_when_the_platform_is_there(reaches, measured_now):
    reaches('publish_pose', '-0.003', 0.002, 0.044, '--rpy', 0.03, 0, 0.05)
    pose = measured_now()
    assert pose.position == pytest.approx([-0.003, 0.002, 0.044], abs=5e-4)
    assert pose.rpy == pytest.approx([0.03, 0.0, 0.05], abs=0.01)


def test_publish_pose_reports_which_leg_cannot(start, client, end):
    status, said = end(start('publish_pose', 0.04, 0, 0.045))
    assert status == 1
    assert re.fullmatch(r'refused: leg \d: rod too short by [\d.]+ mm .*\n', said)


def test_publish_pose_asks_whether_degrees_or_millimetres_were_meant(start, client, end):
    status, said = end(start('publish_pose', 0, 0, 0.045, '--rpy', 0, 0, 10))
    assert (status, said.count('\n')) == (1, 1)
    assert 'are these degrees?' in said
    status, said = end(start('publish_pose', 0, 0, 45))
    assert status == 1
    assert 'are these millimetres?' in said


def test_watch_joints_prints_names_and_radians(start, reaches, end):
    reaches('publish_pose', 0, 0, 0.04119)
    status, said = end(start('watch_joints', '--count', 3, '--every', 0.02))
    names, *lines = (line.split() for line in said.splitlines())
    assert status == 0
    assert names == [f'crank_{leg}' for leg in range(1, 7)]
    assert len(lines) == 3
    assert [float(word) for word in lines[-1]] == pytest.approx([2.0945] * 6, abs=0.01)


def test_draw_circle_stays_on_it(start, poses, client, end):
    """Where this computer stands still, the machine holds or cuts across: then another circle."""

    def draw():
        poses.clear()
        process = start('draw_circle', '--turns', 1, '--period', 5)
        status, said = end(process)
        client.spin(0.3)  # the platform is a little behind
        assert status == 0
        assert re.search(r'half of them within [\d.]+ mm, all within [\d.]+', said)
        x, y, _ = np.transpose([pose.position for pose in poses])
        on_circle = abs(np.hypot(x, y) - 0.008) < 5e-4
        found.update((a > 0, b > 0) for a, b in zip(x[on_circle], y[on_circle], strict=True))
        return len(found) == 4 and np.mean(on_circle) > 0.5

    found = set()
    assert any(client.persist(draw) for _ in range(5))


def test_axis_tour_visits_both_sides_of_every_axis(start, poses, client, end):
    def drive():
        process = start('axis_tour', '--way', 0.003, '--angle', 0.06, '--pause', 0.1)
        status, said = end(process)
        assert status == 0, said
        return said

    said = client.persist(drive)
    tour = ['x', 'y', 'z', 'roll', 'pitch', 'yaw']
    assert [line.split()[0] for line in said.splitlines()] == tour
    for axis, centre in enumerate((0.0, 0.0, 0.04119)):
        visited = [pose.position[axis] - centre for pose in poses]
        assert min(visited) < -0.0027
        assert max(visited) > 0.0027
        angles = [pose.rpy[axis] for pose in poses]
        assert min(angles) < -0.055
        assert max(angles) > 0.055


@pytest.fixture
def slowly(client):
    """The machine at a twentieth of its speed."""
    override = client.node.create_publisher(Float64, 'speed_override', LATCHED)
    client.wait('a listener', override.get_subscription_count, 10.0)
    override.publish(Float64(data=0.05))
    yield override
    override.publish(Float64(data=1.0))
    override.wait_for_all_acked()
    client.node.destroy_publisher(override)


def test_slow_moves_are_waited_for_and_what_stands_still_is_given_up(
    start, client, slowly, monkeypatch, end
):
    def wait_for_slow_ones():
        client.go_to(Pose.from_xyz_rpy((0.0, 0.008, 0.045)))
        begin = time.monotonic()
        assert end(start('publish_pose', 0, 0, 0.045, '--patience', 2.5)) == (0, 'reached\n')
        assert time.monotonic() - begin > 3.0

    client.persist(wait_for_slow_ones)
    slowly.publish(Float64(data=0.0))
    client.spin(0.5)
    status, said = end(start('publish_pose', 0, 0, 0.043, '--patience', 1.5))
    assert (status, said) == (1, 'not there, and nothing has moved for 1.5 s\n')
    monkeypatch.setattr(client, 'patience', 0.0)
    with pytest.raises(TimedOut, match=r'waited 1.5 s in vain for reaching the goal .*moving'):
        client.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.042)), seconds=1.5)
    assert end(start('stop'))[0] == 0


def test_stop_ends_a_move_and_the_tour_reports_that(start, client, slowly, end):
    def stop_on_tour():
        tour = start('axis_tour', '--pause', 0)
        assert tour.stdout.readline().startswith('x ±')
        assert end(start('stop')) == (0, 'braking along the path, then holding\n')
        status, said = end(tour)
        assert status == 1
        assert 'stopped' in said

    client.persist(stop_on_tour)


def test_emergency_stop_holds_until_it_is_cleared(start, client, reaches, end):
    assert end(start('stop', '--emergency')) == (0, 'stopped\n')
    client.wait('the stop', lambda: client.machine_state.message == 'stopped')
    status, said = end(start('publish_pose', 0, 0, 0.045))
    assert status == 1
    assert 'the machine is stopped' in said
    client.trigger('serial_bridge/clear_fault')
    reaches('publish_pose', 0, 0, 0.045)
