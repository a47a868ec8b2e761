"""Paths through the whole graph: driven exactly, refused by length, replaced by newer goals."""

import struct

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64

from manipulator.errors import Refused
from manipulator.nodes.messages import pose_of, seconds
from manipulator.nodes.path_goals import path_message
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from manipulator.pose import Pose
from manipulator.trajectory.shapes import arc

pytestmark = [pytest.mark.graph, pytest.mark.real_time]

RADIUS, HEIGHT = 0.008, 0.045


def circle(count, turns=1.0):
    angle = np.linspace(0.0, 2 * np.pi * turns, count)
    ring = [RADIUS * np.cos(angle), RADIUS * np.sin(angle), np.full(count, HEIGHT)]
    return Pose(np.stack(ring, axis=1), np.eye(3))


@pytest.fixture
def paths(enabled):
    """Publishes paths, raw or not; the machine is at home and at full speed."""
    publisher = enabled.node.create_publisher(Path, 'goal_path', COMMAND)
    enabled.wait('a listener', lambda: publisher.get_subscription_count() > 0, 10.0)
    enabled.home()
    yield publisher
    enabled.node.destroy_publisher(publisher)


def heard(user, topic):
    messages = []
    user.node.create_subscription(PoseStamped, topic, messages.append, MEASUREMENT)
    return messages


def test_circle_of_120_poses_is_driven_within_half_a_millimetre(enabled, paths):
    measured = heard(enabled, 'pose')
    enabled.go_to(circle(120)[0])
    enabled.spin(0.3)
    measured.clear()
    enabled.follow(circle(120), 30.0)
    enabled.spin(0.2)
    points = np.array([pose_of(m).position for m in measured])
    assert len(points) > 30
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - RADIUS).max() < 0.0005
    assert np.abs(points[:, 2] - HEIGHT).max() < 0.0005
    angles = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert np.ptp(angles) > 0.98 * 2 * np.pi
    assert enabled.motion('mode') == 'hold'


def test_path_from_elsewhere_is_approached_first_and_its_progress_told(enabled, paths):
    told = []
    stamp = enabled.node.get_clock().now().to_msg()
    paths.publish(path_message(circle(200, turns=3.0), stamp))
    for result in ('planning', 'moving'):
        enabled.wait(result, lambda r=result: enabled.motion('result') == r, 10.0)
    enabled.wait('the path', lambda: enabled.motion('mode') == 'path', 10.0)

    def is_reached():
        told.append(enabled.motion('percent'))
        return enabled.motion('result') == 'reached'

    enabled.wait('its end', is_reached, 30.0)
    percents = [int(p) for p in told if p]
    assert percents == sorted(percents)
    assert len(set(percents)) >= 4
    assert enabled.motion('goal_stamp') == f'{seconds(stamp):.9f}'


def huge_path(count):
    """Bytes of a path of so many poses, which are all zeros; without a stamp."""
    whole = serialize_message(Path())
    return whole[:-4] + struct.pack('<I', count) + bytes(80 * count)


@pytest.mark.parametrize('count', [2001, 1_250_000])
def test_path_of_too_many_poses_is_refused_by_length_and_the_stream_goes_on(enabled, paths, count):
    stream, states = heard(enabled, 'setpoint'), []
    enabled.node.create_subscription(
        DiagnosticStatus, 'machine_state', lambda m: states.append(m.message), LATCHED
    )
    enabled.wait('setpoints', lambda: len(stream) > 10, 5.0)
    paths.publish(huge_path(count))
    enabled.wait('refusal', lambda: f'{count:,} poses' in enabled.motion_status.message, 20.0)
    stream.clear()
    enabled.wait('setpoints', lambda: len(stream) > 10, 5.0)
    assert set(states) == {'enabled'}
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.044)))


def test_none_is_refused_one_is_a_goal_and_repeated_ones_are_one(enabled, paths):
    with pytest.raises(Refused, match='0 poses'):
        enabled.follow(Pose(np.zeros((0, 3)), np.zeros((0, 3, 3))))
    goal = Pose(np.tile([0.003, 0.0, 0.044], (5, 1)), np.eye(3))
    for count in (1, 5):
        enabled.follow(goal[:count])
        enabled.spin(0.2)
        measured = heard(enabled, 'pose')
        enabled.wait('a pose', lambda m=measured: bool(m), 5.0)
        assert np.abs(pose_of(measured[-1]).position - goal.position[0]).max() < 0.0005
        enabled.home()


def test_what_cannot_be_driven_is_refused_with_pose_leg_and_limit_before_anything_moves(
    enabled, paths
):
    far = arc(Pose.from_xyz_rpy((0.0, 0.0, 0.0412)), (0.05, 0, 0.0412), (0, 0, 1), 1.0)
    measured = heard(enabled, 'pose')
    enabled.wait('a pose', lambda: bool(measured), 5.0)
    with pytest.raises(Refused, match=r'pose \d+, .* m along the path: leg'):
        enabled.follow(far)
    assert np.ptp([pose_of(m).position for m in measured], axis=0).max() < 0.0005


def test_broken_pose_is_refused_by_its_number(enabled, paths):
    for change, words in (
        (lambda m: setattr(m.poses[6].pose.position, 'y', float('nan')), 'pose 7: y is nan'),
        (
            lambda m: setattr(m.poses[2].pose.orientation, 'w', 0.0),
            'pose 3: quaternion has',
        ),
        (lambda m: setattr(m.poses[4].header, 'frame_id', 'moon'), "pose 5: frame_id 'moon'"),
        (lambda m: setattr(m.header, 'frame_id', 'moon'), "frame_id 'moon' is unknown"),
    ):
        message = path_message(circle(10), enabled.node.get_clock().now().to_msg())
        change(message)
        paths.publish(message)
        enabled.wait(words, lambda w=words: w in enabled.motion_status.message, 10.0)


def test_newer_goal_takes_the_place_of_a_path_that_is_being_worked_out(enabled, paths):
    stamp = enabled.node.get_clock().now().to_msg()
    paths.publish(path_message(circle(2000), stamp))
    enabled.wait('planning', lambda: enabled.motion('result') == 'planning', 5.0)
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.046)))
    enabled.spin(1.5)
    assert enabled.motion('result') == 'reached'
    assert enabled.motion('mode') == 'hold'


def test_path_stops_on_its_way_and_obeys_the_speed_override(enabled, paths):
    overrides = enabled.node.create_publisher(Float64, 'speed_override', COMMAND)
    measured = heard(enabled, 'pose')
    enabled.go_to(circle(2)[0])
    enabled.wait('a listener', lambda: overrides.get_subscription_count() > 0, 10.0)
    overrides.publish(Float64(data=0.2))
    measured.clear()
    paths.publish(path_message(circle(120), enabled.node.get_clock().now().to_msg()))
    enabled.wait('the path', lambda: enabled.motion('mode') == 'path', 10.0)
    enabled.spin(1.5)
    enabled.trigger('trajectory/stop')
    enabled.wait('a stop', lambda: enabled.motion('result') == 'stopped', 5.0)
    overrides.publish(Float64(data=1.0))
    points = np.array([pose_of(m).position for m in measured])
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - RADIUS).max() < 0.0005
    turned = np.ptp(np.unwrap(np.arctan2(points[:, 1], points[:, 0])))
    assert 0.5 < turned < 4.0
