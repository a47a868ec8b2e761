"""Publishers that a machine does not receive are told on /diagnostics, by the node concerned."""

import pytest
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Path
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from trajectory_msgs.msg import JointTrajectory

from manipulator.nodes.qos import COMMAND

pytestmark = pytest.mark.graph

TWIST = 'publishes geometry_msgs/msg/Twist, which is not received: publish geometry_msgs/msg/Twi'
RELIABLE = 'is not received: its quality of service must be reliable'
CASES = [
    ('trajectory', Twist, 'cmd_vel', COMMAND, TWIST),
    ('trajectory', PoseStamped, 'goal_pose', qos_profile_sensor_data, RELIABLE),
    ('trajectory', Path, 'goal_path', qos_profile_sensor_data, RELIABLE),
    ('ik', PoseStamped, 'setpoint', qos_profile_sensor_data, RELIABLE),
    ('pose', JointState, 'joint_states', qos_profile_sensor_data, RELIABLE),
    ('serial_bridge', JointState, 'joint_command', qos_profile_sensor_data, RELIABLE),
    ('serial_bridge', Bool, 'emergency_stop', qos_profile_sensor_data, RELIABLE),
    ('serial_bridge', JointTrajectory, 'joint_table', qos_profile_sensor_data, RELIABLE),
]


@pytest.mark.parametrize(('node', 'message_type', 'topic', 'qos', 'told'), CASES)
def test_publisher_that_is_not_received_is_told(user, node, message_type, topic, qos, told):
    def said():
        status = user.diagnostics.get(f'hexapod/{node}')
        return status.message if status else ''

    publisher = user.node.create_publisher(message_type, topic, qos)
    try:
        told = f'{topic}: /hexapod/hexarm {told}'
        user.wait(told, lambda: told in said(), 20.0)
    finally:
        user.node.destroy_publisher(publisher)
    user.wait('the end of it', lambda: told not in said(), 20.0)
