"""The whole graph of an arm with encoders: one of each thing that can be asked of it.

What jogs and goals do in time, test/world tries; what jog modes hold, test/streams.
"""

import itertools
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from std_msgs.msg import Bool, Float64

from hexarm.machines import load
from manipulator.nodes.messages import joints_of
from manipulator.nodes.qos import COMMAND, EVERY_WORD
from manipulator.planning.path import arc
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

HOME = load('arm_6r_stepper').kinematics.home


def test_goal_is_reached_and_the_encoders_report_so(arm, listen):
    goal = HOME.moved([0.1, -0.05, 0.05, 0.0, 0.2, 0.1])
    received = listen()

    def is_there():
        error = received.poses[-1].twist_to(goal) if received.messages else np.ones(6)
        return np.abs(error[:3]).max() < 5e-4 and np.abs(error[3:]).max() < np.radians(0.05)

    def go():
        arm.go_to(goal)
        arm.wait_while_driven('the joints', is_there)
        assert arm.motion('result') == 'reached'

    arm.persist(go)


def test_a_goal_that_is_a_point_holds_the_orientation_where_the_parameter_says_so(arm, listen):
    client = arm.node.create_client(SetParameters, 'trajectory/set_parameters')
    arm.wait('the service', client.service_is_ready)

    def choose(name):
        value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=name)
        parameter = Parameter(name='goal_orientation', value=value)
        answer = arm.answer_of(client, SetParameters.Request(parameters=[parameter]), 'the change')
        return answer.results[0]

    refused = choose('straight')
    assert not refused.successful
    assert 'is not one of given, hold_orientation, parallel, look_at' in refused.reason
    received = listen()

    def is_there():
        error = received.poses[-1].twist_to(HOME) if received.messages else np.ones(6)
        return abs(error[0] + 0.05) < 5e-4 and np.abs(error[3:]).max() < np.radians(0.05)

    def go():
        arm.home()
        assert choose('hold_orientation').successful
        try:
            arm.go_to(Pose(HOME.position + np.array([0.05, 0.0, 0.05]), np.eye(3)))
        finally:
            assert choose('given').successful
        arm.wait_while_driven('the joints', is_there)

    arm.persist(go)


def test_path_is_driven_within_a_millimetre(arm, listen):
    """Again where this computer stood still: what catches up cuts across."""
    x, y, z = HOME.position
    ring = arc(HOME, (x, y - 0.05, z), (1.0, 0.0, 0.0), 2 * np.pi)
    received = listen()

    def drive():
        arm.go_to(ring[0])
        arm.wait('rest', received.is_at_rest)
        received.messages.clear()
        arm.follow(ring)
        y_of, z_of = np.array([pose.position[1:] for pose in received.poses]).T
        if np.ptp(z_of) < 0.09:
            return np.inf  # not all of it was heard
        return np.abs(np.hypot(y_of - y + 0.05, z_of - z) - 0.05).max()

    assert any(arm.persist(drive) < 1e-3 for _ in range(5))


def test_jog_is_smooth_and_ends_in_a_hold_when_the_stick_is_released(arm, joystick, listen):
    commands = listen('joint_command')

    def push():
        arm.reach_home()
        commands.messages.clear()
        arm.wait_while_driven(
            '80 mm', lambda: joystick.has_pushed([0.2, 0, 0, 0, 0, 0], commands, 0.08)
        )
        joystick.send()
        arm.wait_while_driven(
            'rest', lambda: (arm.motion('mode'), arm.motion('result')) == ('hold', 'idle')
        )

    arm.persist(push)
    commands.check_smooth()


def test_killed_source_stops_the_arm(arm, listen):
    commands = listen('joint_command')
    script = textwrap.dedent(
        """
        import time, rclpy
        from geometry_msgs.msg import TwistStamped
        rclpy.init()
        node = rclpy.create_node('doomed')
        publisher = node.create_publisher(TwistStamped, '/arm/cmd_vel/panel', 1)
        message = TwistStamped()
        message.twist.linear.x = 0.01
        while True:
            message.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(message)
            time.sleep(0.02)
        """
    )

    def jog_and_kill():
        source = subprocess.Popen([sys.executable, '-c', script])
        try:
            arm.wait_while_driven('jogging', lambda: arm.motion('mode') == 'jog')
        finally:
            source.kill()
            source.wait()
        arm.wait_while_driven('standing still', lambda: arm.motion('mode') == 'hold')
        commands.messages.clear()
        arm.wait_while_driven('rest', commands.is_at_rest)

    arm.persist(jog_and_kill)


def test_bad_twists_modes_and_frames_are_refused_and_the_arm_stays(arm, joystick, listen):
    received = listen('joint_command')
    joystick.mode('upside_down')

    def reported():
        status = arm.diagnostics.get('arm/trajectory')
        return {v.key: v.value for v in status.values} if status else {}

    def is_refused(twist, frame, words):
        joystick.send(twist, frame)
        arm.spin(0.02)
        return words in reported().get('last_twist_refusal', '')

    def send_bad_ones():
        for twist, frame, words in (
            ([np.nan, 0, 0, 0, 0, 0], '', 'is not finite'),
            ([0.1, 0, 0, 0, 0, 0], 'moon', "'moon' is not one of"),
        ):
            arm.wait_while_driven(words, lambda t=twist, f=frame, w=words: is_refused(t, f, w))
        assert arm.motion('mode') == 'hold'

    arm.persist(send_bad_ones)
    assert np.ptp(received.joints, axis=0).max() < 1e-3
    assert reported()['jog_mode'] == 'free'


def test_gripper_opens_while_the_arm_stands(arm, listen):
    gripper = arm.node.create_publisher(Float64, 'gripper', COMMAND)
    arm.wait('a listener', lambda: gripper.get_subscription_count() > 0)
    received = listen()

    def is_open():
        gripper.publish(Float64(data=1.0))
        arm.spin(0.1)
        last = received.messages[-1:]
        return any(joints_of(m, ('gripper',))[0] > np.radians(49.0) for m in last)

    arm.wait_driven('the gripper', is_open)
    assert np.ptp(received.joints, axis=0).max() < 1e-3


def test_emergency_stop_ends_a_motion_and_nothing_resumes_after_the_clear(arm, listen):
    stops = arm.node.create_publisher(Bool, 'emergency_stop', EVERY_WORD)
    arm.wait('a listener', lambda: stops.get_subscription_count() > 0)
    goals = itertools.cycle([HOME.moved([0.25, 0, 0, 0, 0, 0]), HOME])

    def is_moving():
        if arm.motion('mode') == 'hold':
            arm.publish_goal(next(goals))
            arm.spin(0.5)
        return arm.motion('mode') == 'move'

    arm.wait_driven('moving', is_moving)
    stops.publish(Bool(data=True))
    arm.wait_for_state('stopped')
    arm.make_ready()
    arm.wait_driven('goals', lambda: arm.motion('mode') == 'hold')
    received = listen('joint_command')
    arm.wait_driven('commands', lambda: len(received.messages) > 50)
    assert np.ptp(received.joints, axis=0).max() < 1e-3
    arm.node.destroy_publisher(stops)
