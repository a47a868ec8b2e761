"""Goals, cycles and the gripper of the arm, as its encoders tell them."""

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Float64

from hexarm.machines import load
from manipulator.errors import Refused
from manipulator.nodes.messages import joints_of
from manipulator.nodes.qos import COMMAND, MEASUREMENT

pytestmark = [pytest.mark.graph, pytest.mark.real_time]

HOME = load('arm_6r_stepper').kinematics.home


def test_home_pose_is_heard_on_pose(arm):
    poses = []
    arm.node.create_subscription(PoseStamped, 'pose', poses.append, MEASUREMENT)
    arm.wait('a pose', lambda: len(poses) > 3, 5.0)
    p = poses[-1].pose.position
    assert np.abs(np.array([p.x, p.y, p.z]) - HOME.position).max() < 5e-4


def test_goal_is_reached_and_the_encoders_say_so(arm, listen):
    goal = HOME.moved([0.1, -0.05, 0.05, 0.0, 0.2, 0.1])
    arm.go_to(goal)
    arm.spin(0.2)
    heard = listen()  # what was said on the way may still wait to be heard
    arm.wait('joints', lambda: len(heard.messages) > 3, 5.0)
    error = heard.poses[-1].twist_to(goal)
    assert np.abs(error[:3]).max() < 5e-4
    assert np.abs(error[3:]).max() < np.radians(0.05)


def test_goal_out_of_reach_is_refused_in_words(arm):
    with pytest.raises(Refused, match='reach is'):
        arm.go_to(HOME.moved([1.0, 0, 0, 0, 0, 0]))


def test_cycle_swings_until_it_is_stopped(arm, listen):
    heard = listen()
    arm.trigger('trajectory/start_cycle')
    arm.wait('cycling', lambda: arm.motion('mode') == 'cycle', 5.0)
    arm.spin(2.5)
    assert np.ptp([pose.position[0] for pose in heard.poses]) > 0.004
    arm.trigger('trajectory/stop')
    arm.wait('stopping', lambda: arm.motion('result') == 'stopped', 5.0)


def test_gripper_opens_while_the_arm_stands(arm, listen):
    gripper = arm.node.create_publisher(Float64, 'gripper', COMMAND)
    arm.wait('a listener', lambda: gripper.get_subscription_count() > 0, 10.0)
    heard = listen()
    gripper.publish(Float64(data=1.0))
    arm.wait(
        'the gripper',
        lambda: (
            joints_of(heard.messages[-1], ('gripper',))[0] > np.radians(49.0)
            if heard.messages
            else False
        ),
        5.0,
    )
    assert np.ptp(heard.joints, axis=0).max() < 1e-3
