"""`goal_joints` and `joint_trajectory`: judged by their length first, then by what they say."""

from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('trajectory_msgs')

from builtin_interfaces.msg import Duration, Time
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from hexarm.client import time_message
from manipulator.errors import InvalidInput
from manipulator.nodes.joint_topics import JointTopics
from manipulator.nodes.qos import COMMAND
from manipulator.planning.joint_points import MOST_POINTS, InvalidJoints

NAMES = tuple(f'joint_{k}' for k in range(1, 7))


class Driver:
    """In place of a controller: keeps what is asked for."""

    def __init__(self):
        kinematics = SimpleNamespace(joint_names=NAMES)
        self.supervisor = SimpleNamespace(machine=SimpleNamespace(kinematics=kinematics))
        self.asked, self.refused = [], []

    def move_joints(self, named, stamp, refuse, now):
        self.asked.append(named)

    def follow_joints(self, trajectory, refuse, now):
        self.asked.append((trajectory, now))

    def refuse(self, stamp, error):
        self.refused.append(str(error))


@pytest.fixture
def driver(graph):
    """One whose node receives both topics; `send` publishes a message on one."""
    node, user, made = graph.node('trajectory'), graph.node('user'), Driver()
    JointTopics(node, made, np.full(6, 0.01))
    publishers = {
        kind: user.create_publisher(kind, topic, COMMAND)
        for kind, topic in ((JointState, 'goal_joints'), (JointTrajectory, 'joint_trajectory'))
    }

    def send(message):
        publisher = publishers[type(message)]
        graph.wait('a match', lambda: publisher.get_subscription_count() == 1)
        publisher.publish(message)
        graph.wait('what becomes of it', lambda: made.asked or made.refused)

    made.send, made.now = send, lambda: user.get_clock().now().nanoseconds * 1e-9
    return made


def trajectory(count=3, start=0.0, step=0.1, names=NAMES):
    numbers = [0.0] * len(names)
    points = [
        JointTrajectoryPoint(
            positions=numbers,
            velocities=numbers,
            accelerations=numbers,
            time_from_start=Duration(sec=int(k * step), nanosec=round(k * step % 1 * 1e9)),
        )
        for k in range(count)
    ]
    made = JointTrajectory(joint_names=list(names), points=points)
    made.header.stamp = time_message(start) if start else Time()
    return made


def test_positions_of_named_joints_are_taken(driver):
    message = JointState(name=['joint_2', 'joint_1'], position=[0.2, 0.1])
    message.header.stamp = time_message(driver.now())
    driver.send(message)
    assert driver.asked == [{'joint_2': 0.2, 'joint_1': 0.1}]


@pytest.mark.parametrize(
    ('names', 'positions', 'reason'),
    [
        (['joint_1', 'joint_1'], [0.1, 0.2], 'joint joint_1 is named twice'),
        (['joint_1', 'joint_2'], [0.1], '2 names but 1 position'),
        (['x' * 50_000], [0.1], 'bytes, at most 10000'),
    ],
)
def test_names_and_positions_that_do_not_match_are_refused(driver, names, positions, reason):
    message = JointState(name=names, position=positions)
    message.header.stamp = time_message(driver.now())
    driver.send(message)
    assert driver.refused[0].endswith(reason)


def test_the_longest_trajectory_is_taken_and_decoded_only_when_it_is_planned(driver):
    driver.send(trajectory(MOST_POINTS))
    ((goal, _),) = driver.asked
    assert goal.starts_at is None
    points = goal.read()
    assert len(points.times) == MOST_POINTS
    assert points.times[-1] == pytest.approx(0.1 * (MOST_POINTS - 1))


def test_a_longer_one_is_refused_by_its_bytes(driver):
    driver.send(trajectory(MOST_POINTS + 1300))
    assert 'bytes, limit 500,000: 2,000 points take less' in driver.refused[0]


def test_a_trajectory_begins_by_its_stamp_and_is_named_by_it(driver):
    start = driver.now() + 50.0
    driver.send(trajectory(start=start))
    ((goal, now),) = driver.asked
    assert start - driver.now() <= goal.starts_at - now <= 50.0
    assert goal.stamp == pytest.approx(start, abs=1e-6)


def test_one_that_begins_in_an_hour_is_refused(driver):
    driver.send(trajectory(start=driver.now() + 3600.0))
    assert 'at most 60 s: is the clock of its sender right?' in driver.refused[0]


@pytest.mark.parametrize(
    ('message', 'error'),
    [(trajectory(names=('elbow',)), InvalidJoints), (trajectory(step=0.0), InvalidInput)],
)
def test_what_is_wrong_within_is_found_where_it_is_decoded(driver, message, error):
    driver.send(message)
    ((goal, _),) = driver.asked
    with pytest.raises(error):
        goal.read()
