"""The whole graph of a stack: a goal and a jog, checked on all 18 reported joints."""

import numpy as np
import pytest
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import JointState

from hexarm.machines import load
from manipulator.nodes.messages import joints_of
from manipulator.nodes.qos import COMMAND, MEASUREMENT

pytestmark = pytest.mark.graph

MACHINE = load('stack_6_6')
KINEMATICS = MACHINE.kinematics
NEAR = 5e-4
"""Metres and radians: steps of the servos, and what three sections make of them."""


def test_a_goal_and_a_jog_move_all_sections_as_the_rule_says(stack):
    received = []
    stack.node.create_subscription(
        JointState,
        'joint_states',
        lambda m: received.append(joints_of(m, KINEMATICS.joint_names)),
        MEASUREMENT,
    )
    goal = KINEMATICS.home.moved([0.03, -0.01, 0.02, 0.05, 0.1, 0.1])
    stack.reach(goal)

    def is_there():
        return bool(received) and np.abs(received[-1] - KINEMATICS.inverse(goal)).max() < NEAR

    stack.wait('the joints', is_there)
    sticks = stack.node.create_publisher(TwistStamped, 'cmd_vel/joy', COMMAND)
    stack.wait('a listener', lambda: sticks.get_subscription_count() > 0)

    def has_gone():
        message = TwistStamped()
        message.header.stamp = stack.node.get_clock().now().to_msg()
        message.twist.linear.x = -0.02
        sticks.publish(message)
        stack.spin(0.02)
        return KINEMATICS.forward(received[-1]).pose.position[0] < goal.position[0] - 0.01

    stack.wait_driven('the jog', has_gone)
    stack.wait('rest', lambda: stack.motion('mode') == 'hold')
    assert KINEMATICS.forward(received[-1]).pose.position[0] < goal.position[0] - 0.01
    for joints in received:
        end = KINEMATICS.forward(joints).pose
        assert MACHINE.constraints.admits(end, joints)
        assert np.abs(KINEMATICS.inverse(end) - joints).max() < 2 * NEAR
