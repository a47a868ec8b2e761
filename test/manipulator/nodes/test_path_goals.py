"""`goal_path`: judged by length and header at once, decoded where it is worked out."""

from contextlib import suppress
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('nav_msgs')

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, Quaternion
from nav_msgs.msg import Path
from rclpy.serialization import deserialize_message, serialize_message

from manipulator import rotation as so3
from manipulator.errors import InvalidInput
from manipulator.nodes.parameters import GoalParameters
from manipulator.nodes.path_goals import (
    MOST_BYTES,
    MOST_POSES,
    PathGoals,
    path_message,
    path_of,
)
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.subscriptions import decoded, raw_message
from manipulator.planning.orientation import OrientationRule
from manipulator.pose import Pose

STAMP = Time(sec=1_700_000_000, nanosec=123_456_789)


def poses(count):
    rng = np.random.default_rng(count)
    return Pose(rng.normal(size=(count, 3)), so3.exp(rng.normal(size=(count, 3))))


def written(count=7, frame='base', stamps=None):
    return path_message(poses(count), STAMP, frame, stamps)


@pytest.mark.parametrize('frame', ['base', 'work'])
@pytest.mark.parametrize('count', [1, 2, 7])
def test_poses_are_those_that_were_written(frame, count):
    found, stamps = path_of(written(count, frame))
    assert stamps is None
    assert np.abs(found.twist_to(poses(count))).max() < 1e-9


def test_frames_of_poses_may_be_empty_and_that_of_the_path_too():
    message = written()
    message.poses[2].header.frame_id = message.header.frame_id = ''
    found, _ = path_of(message)
    assert np.abs(found.twist_to(poses(7))).max() < 1e-9


def test_stamps_come_in_seconds_from_the_first_to_the_nanosecond():
    stamps = [Time(sec=1_700_000_000 + k // 2, nanosec=k % 2 * 500_000_001) for k in range(4)]
    _, seconds = path_of(written(4, stamps=stamps))
    np.testing.assert_allclose(seconds, [0.0, 0.500000001, 1.0, 1.500000001], atol=1e-12)


def test_stamps_that_go_back_are_refused_by_their_pose():
    stamps = [Time(sec=s) for s in (1, 2, 3, 3, 4)]
    with pytest.raises(InvalidInput, match='pose 4: its stamp is not after that of pose 3'):
        path_of(written(5, stamps=stamps))


@pytest.mark.parametrize('name', ['x', 'y', 'z'])
def test_number_that_is_none_is_refused_by_name_and_pose(name):
    message = written()
    setattr(message.poses[3].pose.position, name, float('inf'))
    with pytest.raises(InvalidInput, match=f'pose 4: {name} is inf'):
        path_of(message)


@pytest.mark.parametrize(('w', 'length'), [(0.0, '0'), (2.0, '2')])
def test_quaternion_that_is_no_rotation_is_refused_by_its_pose(w, length):
    message = written()
    q = message.poses[2].pose.orientation
    q.x, q.y, q.z, q.w = 0.0, 0.0, 0.0, w
    with pytest.raises(InvalidInput, match=f'pose 3: quaternion has length {length}, a rotation'):
        path_of(message)


@pytest.mark.parametrize('frame', ['moon', 'x' * 200])
def test_pose_in_another_frame_than_its_path_is_refused_by_its_number(frame):
    message = written()
    message.poses[4].header.frame_id = frame
    with pytest.raises(InvalidInput, match=r'pose 5: frame_id .*, the path is in .base.'):
        path_of(message)


@pytest.mark.parametrize('count', [0, MOST_POSES + 1])
def test_too_few_or_too_many_poses_are_refused_by_their_number(count):
    message = Path(poses=[PoseStamped()] * count)
    with pytest.raises(InvalidInput, match=rf'a path of {count:,} poses, needs 1 to 2,000'):
        path_of(message)


def test_quaternions_of_zeros_are_accepted_only_for_points():
    message = path_message(poses(3), STAMP)
    message.poses[1].pose.orientation = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)
    with pytest.raises(InvalidInput, match='pose 2: quaternion has length 0'):
        path_of(message)
    points, _ = path_of(message, are_oriented=False)
    np.testing.assert_array_equal(points.position, poses(3).position)


class Driver:
    """In place of a controller: keeps what is asked for."""

    def __init__(self):
        motion = SimpleNamespace(linear=SimpleNamespace(speed=0.02))
        self.supervisor = SimpleNamespace(machine=SimpleNamespace(motion=motion))
        self.asked, self.refused = [], []

    def orientation_rule(self, orientation, is_of_platform):
        return OrientationRule(orientation)

    def follow(self, path, refuse, now):
        self.asked.append(path)

    def refuse(self, stamp, error):
        self.refused.append(str(error))


@pytest.fixture
def driver(graph):
    """One whose node receives paths; `send` publishes one."""
    node, user, made = graph.node('trajectory'), graph.node('user'), Driver()
    PathGoals(node, made, GoalParameters(node))
    publisher = user.create_publisher(Path, 'goal_path', COMMAND)

    def send(message):
        graph.wait('a match', lambda: publisher.get_subscription_count() == 1)
        publisher.publish(message)
        graph.wait('what becomes of it', lambda: made.asked or made.refused)

    made.send, made.now = send, lambda: user.get_clock().now().to_msg()
    return made


def test_the_longest_path_is_taken_and_decoded_only_when_it_is_worked_out(driver):
    driver.send(path_message(poses(MOST_POSES), driver.now(), 'work'))
    (path,) = driver.asked
    assert not path.is_of_platform
    request = path.read()
    assert np.abs(request.poses.twist_to(poses(MOST_POSES))).max() < 1e-9


def test_a_longer_one_is_refused_by_its_bytes_and_never_decoded(driver, monkeypatch):
    monkeypatch.setattr('manipulator.nodes.path_goals.path_of', None)
    driver.send(path_message(poses(2600), driver.now()))
    assert driver.refused == ['a path of 208,028 bytes, limit 200,000: 2,000 poses take less']


def test_path_in_a_frame_that_is_no_name_is_refused_at_once(driver):
    driver.send(path_message(poses(1), driver.now(), 'x' * 50_000))
    (refused,) = driver.refused
    assert 'is unknown' in refused
    assert len(refused) < 200


def test_header_of_a_huge_message_is_read_and_nothing_else(monkeypatch):
    lengths = []

    def decode(serialized, kind):
        lengths.append(len(serialized))
        return deserialize_message(serialized, kind)

    monkeypatch.setattr('manipulator.nodes.subscriptions.deserialize_message', decode)
    assert (
        raw_message(serialize_message(written()) + bytes(10_000_000), MOST_BYTES).header.stamp
        == STAMP
    )
    assert lengths == [MOST_BYTES]


def test_bytes_that_are_no_path_are_refused_and_nothing_else_happens():
    whole = serialize_message(written())
    rng = np.random.default_rng(0)
    count = whole.index(b'base\0') + 8
    many = whole[:count] + b'\xff' * 4 + whole[count + 4 :]
    broken = [b'', b'\0', b'\0\1\0\0', whole[:40], many]
    for _ in range(300):
        one = bytearray(whole[: rng.integers(1, len(whole))])
        for k in rng.integers(0, len(one), 3):
            one[k] = rng.integers(0, 256)
        broken.append(bytes(one))
    for one in broken:
        raw_message(one, MOST_BYTES)
        with suppress(InvalidInput):
            path_of(decoded(one, Path, MOST_BYTES))
