"""What a node does not receive is told with what to change, from the graph as it is."""

import pytest
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from manipulator.nodes.graph_check import Received, crowds, received_by, unreceived
from manipulator.nodes.qos import COMMAND, LATCHED, MEASUREMENT

CASES = {
    'twist without a stamp': (
        'cmd_vel', (TwistStamped, COMMAND), (Twist, COMMAND),
        'cmd_vel: /here/user publishes geometry_msgs/msg/Twist, which is not received: '
        'publish geometry_msgs/msg/TwistStamped',
    ),
    'best-effort goals': (
        'goal_pose', (PoseStamped, COMMAND), (PoseStamped, qos_profile_sensor_data),
        'goal_pose: /here/user is not received: its quality of service must be reliable',
    ),
    'best-effort joints': (
        'joint_command', (JointState, MEASUREMENT), (JointState, qos_profile_sensor_data),
        'joint_command: /here/user is not received: its quality of service must be reliable',
    ),
    'a state that is not latched': (
        'gripper', (Float64, LATCHED), (Float64, COMMAND),
        'gripper: /here/user is not received: its quality of service must be transient local',
    ),
}  # fmt: skip


@pytest.mark.parametrize('case', CASES)
def test_publisher_that_is_not_received_is_reported_with_its_remedy(graph, case):
    topic, wanted, offered, reported = CASES[case]
    machine, user = graph.node('machine'), graph.node('user')
    machine.create_subscription(wanted[0], topic, print, wanted[1])
    user.create_publisher(offered[0], topic, offered[1])
    graph.wait('the publisher', lambda: machine.count_publishers(f'/here/{topic}') == 1)
    graph.wait('its name', lambda: 'unknown' not in str(unreceived(machine, received_by(machine))))
    assert unreceived(machine, received_by(machine)) == [reported]
    assert unreceived(user, [Received(topic, *wanted)]) == [reported]


def test_publishers_that_are_received_are_not_reported(graph):
    machine, user = graph.node('machine'), graph.node('user')
    machine.create_subscription(PoseStamped, 'goal_pose', print, COMMAND)
    machine.create_subscription(JointState, 'joint_states', print, qos_profile_sensor_data)
    for offered in (COMMAND, LATCHED, MEASUREMENT):
        user.create_publisher(PoseStamped, 'goal_pose', offered)
        user.create_publisher(JointState, 'joint_states', offered)
    graph.wait('the publishers', lambda: machine.count_publishers('/here/joint_states') == 3)
    assert unreceived(machine, received_by(machine)) == []


def test_two_publishers_are_reported_with_their_nodes(graph):
    machine, user, other = graph.node('machine'), graph.node('user'), graph.node('other', 'far')
    user.create_publisher(TwistStamped, 'cmd_vel/joy', COMMAND)
    assert crowds(machine, ('cmd_vel/joy',)) == []
    other.create_publisher(TwistStamped, '/here/cmd_vel/joy', COMMAND)
    topics = 'cmd_vel/joy', 'cmd_vel/panel'
    graph.wait('both', lambda: machine.count_publishers('/here/cmd_vel/joy') == 2)
    graph.wait('their names', lambda: 'unknown' not in crowds(machine, topics)[0])
    (reported,) = crowds(machine, topics)
    assert reported.startswith('2 publishers on cmd_vel/joy, which must have one: ')
    assert set(reported.partition(': ')[2].split(', ')) == {'/here/user', '/far/other'}
