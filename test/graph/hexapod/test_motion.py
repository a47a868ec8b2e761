"""The whole graph of the hexapod, seen from outside: one of each thing that can be asked of it.

What goals, paths, jogs and stops do in time, and what is refused, test/world tries.
"""

import subprocess
import sys
import textwrap

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from nav_msgs.msg import Path
from nav_msgs.srv import GetPlan
from rclpy.qos import qos_profile_sensor_data
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import MarkerArray

from manipulator.nodes.messages import pose_message, pose_of
from manipulator.nodes.path_goals import path_message
from manipulator.nodes.qos import COMMAND, MEASUREMENT
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

NEAR = 5e-4
RADIUS, HEIGHT = 0.008, 0.045
POSES = [Pose.from_xyz_rpy((0.0, 0.0, z)) for z in (0.049, 0.045)]


@pytest.fixture
def publisher(enabled):
    """Publishers that somebody listens to; they vanish with the test."""
    made = []

    def publisher(kind, topic):
        made.append(enabled.node.create_publisher(kind, topic, COMMAND))
        enabled.wait('a listener', lambda: made[-1].get_subscription_count() > 0)
        return made[-1]

    yield publisher
    for one in made:
        enabled.node.destroy_publisher(one)


@pytest.fixture
def heard(enabled):
    """All messages on a topic from now on."""
    made = []

    def heard(kind, topic):
        messages = []
        made.append(enabled.node.create_subscription(kind, topic, messages.append, MEASUREMENT))
        enabled.wait(topic, lambda: messages)
        return messages

    yield heard
    for one in made:
        enabled.node.destroy_subscription(one)


def now(user):
    return user.node.get_clock().now().to_msg()


def circle(count):
    angle = np.linspace(0.0, 2 * np.pi, count)
    ring = [RADIUS * np.cos(angle), RADIUS * np.sin(angle), np.full(count, HEIGHT)]
    return Pose(np.stack(ring, axis=1), np.eye(3))


def test_goal_is_reached_and_the_measured_pose_reports_that(enabled, heard):
    goal = Pose.from_xyz_rpy((0.004, -0.003, 0.045), (0.02, 0.03, 0.05))
    poses = heard(PoseStamped, 'pose')

    def is_there():
        error = pose_of(poses[-1]).twist_to(goal)
        return np.abs(error[:3]).max() < NEAR and np.abs(error[3:]).max() < 0.01

    def go():
        enabled.go_to(goal)
        enabled.wait_while_driven('the pose', is_there)
        assert enabled.motion('result') == 'reached'

    enabled.persist(go)


def test_foreign_process_moves_the_platform(enabled, heard):
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
    poses = heard(PoseStamped, 'pose')

    def has_moved():
        subprocess.run([sys.executable, '-c', script], check=True, timeout=60)
        enabled.wait_while_driven(
            'x = 7 mm', lambda: abs(pose_of(poses[-1]).position[0] - 0.007) < NEAR
        )

    enabled.reach_home()
    enabled.persist(has_moved)


def test_path_is_driven_within_half_a_millimetre_around_the_whole_path(enabled, heard):
    """Again where this computer stood still: what catches up cuts across."""
    measured = heard(PoseStamped, 'pose')

    def drive():
        enabled.go_to(circle(120)[0])
        enabled.spin(0.3)
        measured.clear()
        enabled.follow(circle(120))
        assert enabled.motion('mode') == 'hold'
        points = np.array([pose_of(m).position for m in measured])
        beside = np.hypot(points[:, 0], points[:, 1]) - RADIUS
        return max(np.abs(beside).max(), np.abs(points[:, 2] - HEIGHT).max())

    assert any(enabled.persist(drive) < NEAR for _ in range(5))


@pytest.mark.parametrize(
    ('path', 'words'),
    [
        (serialize_message(Path(poses=[PoseStamped()] * 2001)), 'a path of 2,001 poses'),
        (serialize_message(Path()) + bytes(100_000_000), 'a path of 100,000,024 bytes'),
    ],
    ids=['2001 poses', '100 MB'],
)
def test_path_that_is_too_long_is_refused_by_its_length_and_the_next_goal_works(
    enabled, publisher, path, words
):
    def last_refusal():
        status = enabled.diagnostics.get('hexapod/trajectory')
        return {v.key: v.value for v in status.values}['last_refusal'] if status else ''

    publisher(Path, 'goal_path').publish(path)
    enabled.wait('refusal', lambda: words in last_refusal())
    enabled.reach(Pose.from_xyz_rpy((0.0, 0.0, 0.044)))


def change_quaternion(message):
    message.pose.orientation.w = 2.0


def change_frame(message):
    message.header.frame_id = 'moon'


def change_pose_of_path(message):
    message.poses[6].pose.position.y = float('nan')


def test_broken_goals_and_paths_are_refused_in_words_and_the_next_one_works(enabled, publisher):
    goals, paths = publisher(PoseStamped, 'goal_pose'), publisher(Path, 'goal_path')

    def is_refused(topic, message, words):
        message.header.stamp = now(enabled)
        topic.publish(message)
        enabled.wait_while_driven(words, lambda: words in enabled.motion_status.message)

    for change, words in (
        (change_quaternion, 'quaternion has length 2'),
        (change_frame, "frame_id 'moon' is unknown"),
    ):
        goal = pose_message(Pose.from_xyz_rpy((0.0, 0.0, 0.045)), now(enabled))
        change(goal)
        enabled.persist(lambda g=goal, w=words: is_refused(goals, g, w))
    path = path_message(circle(10), now(enabled))
    change_pose_of_path(path)
    enabled.persist(lambda: is_refused(paths, path, 'pose 7: y is nan'))
    enabled.reach(Pose.from_xyz_rpy((0.0, 0.0, 0.044)))


def test_jog_moves_while_it_is_sent_and_ends_in_a_hold(enabled, publisher, heard):
    enabled.reach_home()
    twists, poses = publisher(TwistStamped, 'cmd_vel/joy'), heard(PoseStamped, 'pose')
    message = TwistStamped()
    message.twist.linear.x = 0.01

    def push():
        message.header.stamp = now(enabled)
        twists.publish(message)
        enabled.spin(0.02)
        return pose_of(poses[-1]).position[0] > 0.002

    def jog():
        enabled.wait_while_driven('2 mm', push)
        enabled.wait_while_driven('rest', lambda: enabled.motion('mode') == 'hold')

    enabled.persist(jog)


def test_services_home_pause_cycle_and_stop_are_obeyed(enabled, heard):
    poses = heard(PoseStamped, 'pose')
    enabled.reach(Pose.from_xyz_rpy((0.004, 0.0, 0.045)))

    def swing():
        enabled.home()
        enabled.trigger('trajectory/start_cycle')
        enabled.wait_while_driven('swinging', lambda: pose_of(poses[-1]).position[0] > 0.001)
        enabled.trigger('trajectory/stop')
        enabled.wait('its end', lambda: enabled.motion('mode') != 'cycle')
        assert enabled.motion('result') == 'stopped'

    enabled.persist(swing)


def test_plan_answers_the_path_or_nothing(enabled):
    client = enabled.node.create_client(GetPlan, 'trajectory/plan')
    enabled.wait('the service', client.service_is_ready)

    def lengths():
        found = []
        for x in (0.005, 0.05):
            goal = pose_message(Pose.from_xyz_rpy((x, 0.0, 0.0412)), now(enabled))
            answer = enabled.answer_of(client, GetPlan.Request(goal=goal), 'the plan')
            found.append(len(answer.plan.poses))
        assert found[0] > 10
        assert found[1] == 0

    enabled.persist(lengths)


def test_a_client_that_is_informed_that_the_machine_was_cleared_may_ask_for_motion_at_once(
    enabled,
):
    """At which tick the goal comes, test/world/test_commands.py tries."""
    path = Pose(np.array([p.position for p in POSES]), np.array([p.rotation for p in POSES]))
    goals = [lambda pose=pose: enabled.go_to(pose) for pose in POSES * 3]

    def at_once(ask):
        enabled.trigger('serial_bridge/stop')
        enabled.trigger('serial_bridge/clear_fault')
        ask()

    for ask in (*goals, lambda: enabled.follow(path), enabled.home):
        enabled.persist(lambda ask=ask: at_once(ask))


def test_markers_draw_the_machine_for_whoever_listens(enabled, heard):
    markers = heard(MarkerArray, 'markers')[-1].markers
    parts = [marker.ns for marker in markers]
    assert parts == ['body', *['crank'] * 6, *['rod'] * 6, 'platform']
    assert all(marker.header.frame_id == 'base' for marker in markers)


TWIST = 'publishes geometry_msgs/msg/Twist, which is not received: publish geometry_msgs/msg/Twi'
RELIABLE = 'is not received: its quality of service must be reliable'
UNHEARD = [
    ('trajectory', Twist, 'cmd_vel', COMMAND, TWIST),
    ('trajectory', PoseStamped, 'goal_pose', qos_profile_sensor_data, RELIABLE),
    ('trajectory', Path, 'goal_path', qos_profile_sensor_data, RELIABLE),
    ('ik', PoseStamped, 'setpoint', qos_profile_sensor_data, RELIABLE),
    ('pose', JointState, 'joint_states', qos_profile_sensor_data, RELIABLE),
    ('serial_bridge', JointState, 'joint_command', qos_profile_sensor_data, RELIABLE),
    ('serial_bridge', Bool, 'emergency_stop', qos_profile_sensor_data, RELIABLE),
    ('serial_bridge', JointTrajectory, 'joint_table', qos_profile_sensor_data, RELIABLE),
]


def test_publishers_that_are_not_received_are_reported_by_the_node_concerned(user):
    def text(node):
        status = user.diagnostics.get(f'hexapod/{node}')
        return status.message if status else ''

    made = [user.node.create_publisher(kind, topic, qos) for _, kind, topic, qos, _ in UNHEARD]
    try:
        for node, _, topic, _, reported in UNHEARD:
            words = f'{topic}: /hexapod/hexarm {reported}'
            user.wait(words, lambda n=node, w=words: w in text(n))
    finally:
        for publisher in made:
            user.node.destroy_publisher(publisher)
    for node, _, topic, *_ in UNHEARD:
        user.wait('the end of it', lambda n=node, w=f'{topic}: ': w not in text(n))
