"""The whole graph of the hexapod, seen from outside."""

import subprocess
import sys
import textwrap

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped, PoseStamped
from nav_msgs.srv import GetPlan
from std_msgs.msg import Float64
from visualization_msgs.msg import MarkerArray

from manipulator.errors import Refused
from manipulator.nodes.messages import pose_message, pose_of
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT
from manipulator.pose import Pose

pytestmark = [pytest.mark.graph, pytest.mark.real_time]


def heard_pose(user):
    poses = []
    subscription = user.node.create_subscription(PoseStamped, 'pose', poses.append, MEASUREMENT)
    user.wait('a pose', lambda: len(poses) > 3, 5.0)
    user.node.destroy_subscription(subscription)
    return pose_of(poses[-1])


def test_goal_is_reached_and_the_measured_pose_says_so(enabled):
    goal = Pose.from_xyz_rpy((0.004, -0.003, 0.045), (0.02, 0.03, 0.05))
    enabled.go_to(goal)
    enabled.spin(0.2)
    error = heard_pose(enabled).twist_to(goal)
    assert np.abs(error[:3]).max() < 0.0005
    assert np.abs(error[3:]).max() < 0.01


def test_foreign_process_moves_the_platform(enabled):
    script = textwrap.dedent(
        """
        import rclpy
        from geometry_msgs.msg import PoseStamped
        rclpy.init()
        node = rclpy.create_node('foreigner')
        publisher = node.create_publisher(PoseStamped, '/hexapod/goal_pose', 1)
        while publisher.get_subscription_count() == 0:
            rclpy.spin_once(node, timeout_sec=0.05)
        goal = PoseStamped()
        goal.pose.position.x, goal.pose.position.z, goal.pose.orientation.w = 0.007, 0.044, 1.0
        publisher.publish(goal)
        publisher.wait_for_all_acked()
        """
    )
    subprocess.run([sys.executable, '-c', script], check=True, timeout=30)
    enabled.wait(
        'the platform at x = 7 mm',
        lambda: abs(heard_pose(enabled).position[0] - 0.007) < 0.0005,
        10.0,
    )
    assert enabled.motion('result') == 'reached'


@pytest.mark.parametrize(
    ('xyz', 'reason'),
    [((0.05, 0.0, 0.0412), 'leg'), ((0.0, 0.0, 0.01), 'height')],
)
def test_unreachable_goal_is_refused_with_its_reason_and_the_next_one_works(enabled, xyz, reason):
    with pytest.raises(Refused, match=reason):
        enabled.go_to(Pose.from_xyz_rpy(xyz))
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043)))


def test_broken_goal_is_refused_in_words_and_the_next_one_works(enabled):
    publisher = enabled.node.create_publisher(PoseStamped, 'goal_pose', COMMAND)
    enabled.wait('a listener', lambda: publisher.get_subscription_count() > 0, 10.0)
    for change, words in (
        (lambda m: setattr(m.pose.position, 'x', float('nan')), 'x is nan'),
        (lambda m: setattr(m.pose.orientation, 'w', 0.0), 'quaternion has length 0'),
        (lambda m: setattr(m.pose.orientation, 'w', 2.0), 'quaternion has length 2'),
        (lambda m: setattr(m.header, 'frame_id', 'moon'), "frame_id 'moon' is unknown"),
    ):
        stamp = enabled.node.get_clock().now().to_msg()
        message = pose_message(Pose.from_xyz_rpy((0.0, 0.0, 0.045)), stamp)
        change(message)
        publisher.publish(message)
        enabled.wait(words, lambda w=words: w in enabled.motion_status.message, 5.0)
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.044)))


def test_services_home_pause_stop_and_cycle(enabled):
    enabled.go_to(Pose.from_xyz_rpy((0.004, 0.0, 0.045)))
    enabled.home()
    assert abs(heard_pose(enabled).position[0]) < 0.0005
    enabled.trigger('trajectory/start_cycle')
    enabled.wait('cycling', lambda: enabled.motion('mode') == 'cycle', 5.0)
    enabled.wait('swinging', lambda: heard_pose(enabled).position[0] > 0.001, 10.0)
    enabled.trigger('trajectory/stop')
    enabled.wait('stopping', lambda: enabled.motion('result') == 'stopped', 5.0)
    before = heard_pose(enabled)
    enabled.spin(0.3)
    assert np.abs(before.twist_to(heard_pose(enabled))).max() < 0.001


def test_speed_override_zero_stands_still_and_one_goes_on(enabled):
    publisher = enabled.node.create_publisher(Float64, 'speed_override', LATCHED)
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.0412)))
    publisher.publish(Float64(data=0.0))
    enabled.spin(0.3)
    enabled.publish_goal(Pose.from_xyz_rpy((0.008, 0.0, 0.0412)))
    enabled.spin(0.5)
    assert abs(heard_pose(enabled).position[0]) < 0.001
    publisher.publish(Float64(data=1.0))
    enabled.wait('the goal', lambda: enabled.motion('result') == 'reached', 10.0)
    assert abs(heard_pose(enabled).position[0] - 0.008) < 0.001


def test_plan_answers_the_way_or_nothing(enabled):
    client = enabled.node.create_client(GetPlan, 'trajectory/plan')
    enabled.wait('the service', client.service_is_ready, 10.0)
    stamp = enabled.node.get_clock().now().to_msg()
    lengths = []
    for x in (0.005, 0.05):
        goal = pose_message(Pose.from_xyz_rpy((x, 0.0, 0.0412)), stamp)
        future = client.call_async(GetPlan.Request(goal=goal))
        enabled.wait('the plan', future.done, 5.0)
        lengths.append(len(future.result().plan.poses))
    assert lengths[0] > 10
    assert lengths[1] == 0


def test_goal_for_a_machine_that_is_not_enabled_is_refused(enabled):
    enabled.disable()
    enabled.wait('disarming', lambda: enabled.motion('mode') == 'disabled', 5.0)
    with pytest.raises(Refused, match='enable it first'):
        enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043)))
    enabled.enable()
    enabled.go_to(Pose.from_xyz_rpy((0.0, 0.0, 0.043)))


def test_pivot_is_where_goals_in_the_work_frame_turn_about(enabled):
    enabled.home()
    pivots = enabled.node.create_publisher(PointStamped, 'pivot', LATCHED)
    readings = []
    enabled.node.create_subscription(PoseStamped, 'pivot_pose', readings.append, MEASUREMENT)
    message = PointStamped()
    message.point.z = 0.03
    pivots.publish(message)
    enabled.wait('the pivot', lambda: bool(readings) and readings[-1].pose.position.z > 0.07, 10.0)
    assert readings[-1].header.frame_id == 'work'
    goals = enabled.node.create_publisher(PoseStamped, 'goal_pose', COMMAND)
    enabled.wait('a listener', lambda: goals.get_subscription_count() > 0, 10.0)
    goal = Pose.from_xyz_rpy((0.0, 0.0, 0.0412 + 0.03), (0.1, 0.0, 0.0))
    goals.publish(pose_message(goal, enabled.node.get_clock().now().to_msg(), 'work'))
    enabled.wait('leaning', lambda: heard_pose(enabled).rpy[0] > 0.098, 10.0)
    pose = heard_pose(enabled)
    assert pose.position[1] == pytest.approx(0.03 * np.sin(0.1), abs=3e-4)
    message.point.z = 0.0
    pivots.publish(message)
    enabled.spin(0.3)


def test_markers_draw_the_machine_for_whoever_listens(enabled):
    heard = []
    enabled.node.create_subscription(MarkerArray, 'markers', heard.append, MEASUREMENT)
    enabled.wait('markers', lambda: len(heard) > 2, 10.0)
    parts = [marker.ns for marker in heard[-1].markers]
    assert parts == ['body', *['crank'] * 6, *['rod'] * 6, 'platform']
    assert all(marker.header.frame_id == 'base' for marker in heard[-1].markers)
