"""Reading paths off the wire, against what ROS itself writes."""

from contextlib import suppress

import numpy as np
import pytest

pytest.importorskip('nav_msgs')

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message

from manipulator import rotation as so3
from manipulator.errors import InvalidInput
from manipulator.nodes.path_cdr import read_head, read_poses
from manipulator.nodes.path_goals import path_message
from manipulator.pose import Pose

STAMP = Time(sec=1_700_000_000, nanosec=123_456_789)


def poses(count):
    rng = np.random.default_rng(count)
    return Pose(rng.normal(size=(count, 3)), so3.exp(rng.normal(size=(count, 3))))


def written(count=7, frame='base', stamps=None):
    return path_message(poses(count), STAMP, frame, stamps)


@pytest.mark.parametrize('frame', ['', 'b', 'ba', 'bas', 'base', 'a frame of some length é'])
@pytest.mark.parametrize('count', [1, 2, 7])
def test_head_and_poses_are_those_that_were_written(frame, count):
    serialized = serialize_message(written(count, frame))
    head = read_head(serialized)
    assert (head.sec, head.nanosec, head.frame_id) == (STAMP.sec, STAMP.nanosec, frame)
    assert head.count == count
    found, stamps = read_poses(serialized, frame)
    assert stamps is None
    assert np.abs(found.twist_to(poses(count))).max() < 1e-9


def test_pose_frames_of_different_lengths_keep_the_alignment():
    message = written()
    message.poses[2].header.frame_id = ''
    message.poses[5].header.frame_id = ''
    found, _ = read_poses(serialize_message(message), 'base')
    assert np.abs(found.twist_to(poses(7))).max() < 1e-9


def test_stamps_come_in_seconds_from_the_first_to_the_nanosecond():
    stamps = [Time(sec=1_700_000_000 + k // 2, nanosec=k % 2 * 500_000_001) for k in range(4)]
    _, seconds = read_poses(serialize_message(written(4, stamps=stamps)), 'base')
    np.testing.assert_allclose(seconds, [0.0, 0.500000001, 1.0, 1.500000001], atol=1e-12)


def test_stamps_that_go_back_are_refused_by_their_pose():
    stamps = [Time(sec=s) for s in (1, 2, 3, 3, 4)]
    with pytest.raises(InvalidInput, match='pose 4: its stamp is not after that of pose 3'):
        read_poses(serialize_message(written(5, stamps=stamps)), 'base')


@pytest.mark.parametrize('name', ['x', 'y', 'z'])
def test_number_that_is_none_is_refused_by_name_and_pose(name):
    message = written()
    setattr(message.poses[3].pose.position, name, float('inf'))
    with pytest.raises(InvalidInput, match=f'pose 4: {name} is inf'):
        read_poses(serialize_message(message), 'base')


@pytest.mark.parametrize(('w', 'length'), [(0.0, '0'), (2.0, '2')])
def test_quaternion_that_is_no_rotation_is_refused_by_its_pose(w, length):
    message = written()
    q = message.poses[2].pose.orientation
    q.x, q.y, q.z, q.w = 0.0, 0.0, 0.0, w
    with pytest.raises(InvalidInput, match=f'pose 3: quaternion has length {length}, a rotation'):
        read_poses(serialize_message(message), 'base')


@pytest.mark.parametrize('frame', ['moon', 'x' * 200])
def test_pose_in_another_frame_than_its_path_is_refused_by_its_number(frame):
    message = written()
    message.poses[4].header.frame_id = frame
    with pytest.raises(InvalidInput, match=r'pose 5: frame_id .*, the path is in .base.'):
        read_poses(serialize_message(message), 'base')


def test_frame_that_is_no_name_is_refused_by_its_length():
    with pytest.raises(InvalidInput, match='a frame_id of 50001 characters'):
        read_head(serialize_message(written(frame='x' * 50_000)))


def test_path_without_poses_is_refused():
    with pytest.raises(InvalidInput, match='0 poses in'):
        read_poses(serialize_message(written(0)), 'base')


def test_count_of_a_huge_message_is_read_at_once():
    serialized = serialize_message(written(7)) + bytes(100_000_000)

    for _ in range(100):
        assert read_head(serialized).count == 7


def test_bytes_that_are_no_path_are_refused_and_nothing_else_happens():
    whole = serialize_message(written())
    rng = np.random.default_rng(0)
    refused = 0
    for _ in range(2000):
        broken = bytearray(whole[: rng.integers(0, len(whole))])
        for k in rng.integers(0, max(len(broken), 1), 3):
            if broken:
                broken[k % len(broken)] = rng.integers(0, 256)
        with suppress(InvalidInput):
            read_poses(bytes(broken), 'base')
            refused -= 1
        refused += 1
    assert refused > 1900
    for nothing in (b'', b'\0', b'\0\1\0\0', b'\0\7\0\0' + whole[4:]):
        with pytest.raises(InvalidInput):
            read_head(nothing)
