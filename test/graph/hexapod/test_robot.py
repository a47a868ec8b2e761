"""`hexarm.Robot` beside a running graph, in this process and in one that gets Ctrl-C."""

import asyncio
import signal
import subprocess
import sys

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Float64

from hexarm import InvalidInput, Refused, Robot, Stopped, TimedOut
from manipulator.nodes.messages import pose_of, seconds
from manipulator.nodes.qos import LATCHED
from manipulator.pose import Pose

pytestmark = pytest.mark.graph
CENTRE = (0.0, 0.0, 0.045)


@pytest.fixture
def robot(enabled):
    with Robot('/hexapod') as robot:
        robot.persist = enabled.persist
        yield robot


@pytest.fixture
def override(enabled):
    """Sets the machine's speed; 1 again at the end."""
    publisher = enabled.node.create_publisher(Float64, 'speed_override', LATCHED)
    enabled.wait('a subscriber', publisher.get_subscription_count, 10.0)
    yield lambda share: publisher.publish(Float64(data=share))
    publisher.publish(Float64(data=1.0))
    publisher.wait_for_all_acked()
    enabled.node.destroy_publisher(publisher)


@pytest.fixture
def setpoints(enabled):
    """Makes a list: time (s) and position of every setpoint from then on."""
    received = []
    subscription = enabled.node.create_subscription(
        PoseStamped,
        'setpoint',
        lambda m: received.append((seconds(m.header.stamp), *pose_of(m).position)),
        1000,
    )

    def since_now():
        begin = seconds(enabled.node.get_clock().now().to_msg())
        enabled.wait_while_driven('new ones', lambda: received and received[-1][0] > begin)
        received.clear()
        return received

    yield since_now
    enabled.node.destroy_subscription(subscription)


def pose_at(robot, *position):
    """The measured pose, once it is there: the board of a busy computer is behind."""
    for _ in range(100):
        pose = robot.pose
        if np.abs(pose.position - position).max() < 5e-4:
            return pose
    raise AssertionError(pose)


def has_stopped(user):
    return user.motion('mode') == 'hold' and user.motion('result') == 'stopped'


def test_named_coordinates_move_and_the_others_stay(robot):
    def move():
        robot.move_to((0.0, 0.002, 0.045, 0.03, 0.0, 0.0))
        robot.move(x=0.003, yaw=0.05)
        return pose_at(robot, 0.003, 0.002, 0.045)

    pose = robot.persist(move)
    assert pose.rpy == pytest.approx([0.03, 0.0, 0.05], abs=0.01)
    assert robot.joints.keys() == {f'crank_{leg}' for leg in range(1, 7)}


def test_a_goal_out_of_reach_is_refused_with_the_reason_alone(robot):
    def refuse():
        with pytest.raises(Refused, match=r'^leg \d: rod too short by [\d.]+ mm'):
            robot.move_to((0.04, 0.0, 0.045))
        with pytest.raises(Refused, match='are these millimetres'):
            robot.move_to((0, 0, 45))
        with pytest.raises(InvalidInput, match='are these degrees'):
            robot.move(yaw=10)
        assert not robot.is_moving

    robot.persist(refuse)


def test_a_path_keeps_its_speed_and_reports_its_progress(robot, setpoints, enabled):
    speed, shares = 0.01, []
    corner = [(0.004, 0.0, 0.045), (0.004, 0.004, 0.045), (0.0, 0.004, 0.047)]

    def follow():
        robot.move_to(corner[0])
        received = setpoints()
        shares.clear()
        robot.follow(corner, speed=speed, progress=shares.append)
        enabled.wait('its end', lambda: received and np.allclose(received[-1][1:], corner[-1]))
        if len({setpoint[1:] for setpoint in received}) < 40:
            raise TimedOut('of some 90 setpoints a busy computer heard the newest alone')
        return received

    times, *positions = np.transpose(robot.persist(follow))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    steps = np.linalg.norm(np.diff(np.transpose(positions), axis=0), axis=1)
    assert steps.sum() > 0.007
    # Stamps are those of ticks, which a busy computer makes late: over many of them it is even.
    moved = np.cumsum(steps)
    spans = (moved[20:] - moved[:-20]) / (times[21:] - times[1:-20])
    assert np.median(spans) < 1.1 * speed


def test_the_speed_of_one_path_is_not_that_of_the_next(robot):
    usual = robot._client._path_speed()

    def follow():
        robot.move(x=0.0, speed=0.004)
        robot.follow([(0.001, 0.0, 0.045), (0.0, 0.0, 0.045)], speed=0.01, wait=False)
        robot.wait()

    robot.persist(follow)
    assert robot._client._path_speed() == usual


def test_a_move_with_a_speed_goes_along_a_line(robot, setpoints, enabled):
    def move():
        robot.move_to(CENTRE)
        received = setpoints()
        robot.move(x=0.004, z=0.047, speed=0.01)
        enabled.wait('its end', lambda: received and abs(received[-1][1] - 0.004) < 1e-5)
        _, x, _, z = np.transpose(received)
        return np.abs(z - 0.045 - x / 2).max()

    assert any(robot.persist(move) < 1e-5 for _ in range(5))  # a stall begins it elsewhere


def test_jogging_moves_while_it_lasts_and_leaves_a_machine_that_takes_goals(robot, enabled):
    def jog():
        robot.move_to(CENTRE)
        robot.jog(vy=0.01, seconds=0.5)
        enabled.wait('the jog', lambda: robot.pose.position[1] > 1e-3)
        robot.move(y=0.0)

    robot.persist(jog)


def test_a_motion_that_is_not_waited_for_can_be_polled_awaited_and_replaced(robot, override):
    def replace():
        robot.move_to(CENTRE)
        robot.move(z=0.047, wait=False)
        while not robot.is_done():
            pass
        robot.move(z=0.045, wait=False)
        asyncio.run(robot.done())
        pose_at(robot, *CENTRE)

    robot.persist(replace)

    def be_replaced():
        override(1.0)
        robot.move_to(CENTRE)
        override(0.01)
        robot.move(x=0.005, wait=False)
        with Robot('/hexapod') as other:
            while not robot.is_moving:
                if robot.is_done():
                    raise TimedOut('the motion was over before it was seen')
            other.move_to(CENTRE, wait=False)
            with pytest.raises(Stopped, match='another goal took its place'):
                robot.wait()
        override(1.0)

    robot.persist(be_replaced)


def test_stop_and_the_end_of_the_block_leave_a_machine_that_holds(enabled, override):
    def leave():
        override(1.0)
        with Robot('/hexapod') as robot:
            robot.move_to(CENTRE)
            override(0.05)
            robot.move(x=0.006, wait=False)
            robot.stop()
            assert not robot.is_moving
            assert robot.is_done()
            robot.move(x=0.006, wait=False)
        enabled.wait_while_driven('rest', lambda: has_stopped(enabled))

    enabled.persist(leave)


def test_a_motion_that_does_not_go_on_times_out_and_is_ended(robot, enabled, override):
    def wait_in_vain():
        override(0.0)
        enabled.spin(0.3)
        with pytest.raises(
            TimedOut, match=r'timed out after 1.5 s, waiting for reaching the goal'
        ):
            robot.move_to((0.0, 0.0, 0.043), timeout=1.5)
        override(1.0)
        enabled.wait_while_driven('rest', lambda: has_stopped(enabled))

    enabled.persist(wait_in_vain)


def test_ctrl_c_in_a_move_brakes_it(enabled, override):
    script = (
        'import signal\n'
        'signal.signal(signal.SIGINT, signal.default_int_handler)\n'
        'from hexarm import Robot\n'
        "with Robot('/hexapod') as robot:\n"
        '    robot.move_to((0.006, 0, 0.045), wait=False)\n'
        '    while not robot.is_moving: robot.is_done()\n'
        "    print('moving', flush=True)\n"
        '    robot.wait()\n'
    )

    def interrupt():
        override(1.0)
        enabled.go_to(Pose.from_xyz_rpy(CENTRE))
        override(0.02)
        process = subprocess.Popen(
            [sys.executable, '-c', script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True,
        )  # fmt: skip
        if (first := process.stdout.readline()) != 'moving\n':
            raise AssertionError(first + enabled.end_of(process)[1])
        process.send_signal(signal.SIGINT)
        status, said = enabled.end_of(process)
        assert status != 0
        assert 'KeyboardInterrupt' in said
        enabled.wait_while_driven('rest', lambda: has_stopped(enabled))

    enabled.persist(interrupt)


def test_limits_and_reach_come_from_the_machine_file_of_the_graph(robot):
    def ask():
        assert robot.limits.joints['crank_1'] == pytest.approx(np.radians([30.0, 210.0]))
        assert robot.limits.speed == pytest.approx(0.05)
        assert robot.reach(CENTRE).is_reachable
        assert robot.reach((0.04, 0.0, 0.045)).reason.startswith('leg ')

    robot.persist(ask)


def test_an_emergency_stop_refuses_everything_until_it_is_cleared(robot):
    def stop():
        robot.emergency_stop()
        assert robot.state == 'stopped'
        with pytest.raises(Refused, match='stopped'):
            robot.move_to(CENTRE)
        with pytest.raises(Refused, match='stopped'):
            robot.move(x=0.0)
        with pytest.raises(Refused, match='stopped'):
            robot.jog(vx=0.01, seconds=0.2)
        robot.clear()
        assert robot.state != 'stopped'

    robot.persist(stop)


def test_home_and_park_return_when_the_machine_is_there(robot):
    def go():
        robot.home()
        pose_at(robot, 0.0, 0.0, 0.04119)
        robot.park(wait=False)
        robot.home()

    robot.persist(go)
