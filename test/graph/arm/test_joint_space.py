"""Joint space through the graph: the topics, and the action by which MoveIt drives an arm."""

import json
import os
import sys

import control_messages
import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from rclpy.action import ActionClient
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from hexarm import Robot
from hexarm.cli.main import main
from hexarm.client import time_message
from hexarm.machines import load
from manipulator.errors import Refused
from manipulator.nodes.messages import joints_of
from manipulator.nodes.qos import COMMAND

pytestmark = pytest.mark.graph

KINEMATICS = load('arm_6r_stepper').kinematics
NAMES = KINEMATICS.joint_names
HOME = KINEMATICS.inverse(KINEMATICS.home).tolist()
NEAR = 2e-3
EXECUTING, SUCCEEDED, CANCELED, ABORTED = 2, 4, 5, 6


@pytest.fixture(scope='module', autouse=True)
def control_msgs(request):
    """In the environment of the graph, and here."""
    missing = control_messages.missing()
    if missing and os.environ.get('REQUIRE_ALL') != '1':
        pytest.skip(f'needs {missing}')
    folder = str(control_messages.built(request.config.cache.mkdir('control_msgs')))
    with pytest.MonkeyPatch.context() as patch:
        known = os.environ.get('PYTHONPATH', '')
        patch.setenv('PYTHONPATH', os.pathsep.join(filter(None, [folder, known])))
        patch.setattr(sys, 'path', [folder, *sys.path])
        yield


def duration(seconds):
    return Duration(sec=int(seconds), nanosec=int(seconds % 1 * 1e9))


def trajectory(*points, names=NAMES):
    """Points are (time, positions of joints 1 and 6), with velocities of zero."""
    still = [0.0] * len(names)
    points = [(time, [first, *HOME[1:5], last]) for time, (first, last) in points]
    return JointTrajectory(
        joint_names=list(names),
        points=[
            JointTrajectoryPoint(
                positions=positions, velocities=still, time_from_start=duration(time)
            )
            for time, positions in points
        ],
    )


def joints(arm):
    received = []
    subscription = arm.node.create_subscription(
        JointState, 'joint_states', received.append, COMMAND
    )
    arm.wait('joints', lambda: len(received) > 2)
    arm.node.destroy_subscription(subscription)
    return joints_of(received[-1], NAMES)


def are_at(arm, **named):
    measured = joints(arm)
    return all(abs(measured[NAMES.index(name)] - at) < NEAR for name, at in named.items())


@pytest.fixture
def publish(arm):
    """Publishes one message on a topic, stamped now where `is_stamped`; its stamp."""

    def send(kind, topic, message, is_stamped=True):
        publisher = arm.node.create_publisher(kind, topic, COMMAND)
        arm.wait(topic, lambda: arm.reaches(publisher))
        stamp = arm.node.get_clock().now().nanoseconds * 1e-9
        if is_stamped:
            message.header.stamp = time_message(stamp)
        publisher.publish(message)
        publisher.wait_for_all_acked()  # what is not yet received vanishes with its publisher
        arm.node.destroy_publisher(publisher)

    return send


def test_goal_joints_moves_the_named_joints_and_a_bad_one_is_refused(arm, publish):
    def go():
        publish(JointState, 'goal_joints', JointState(name=['joint_9'], position=[0.1]))
        arm.wait('refusal', lambda: "joint 'joint_9' is unknown" in arm.motion('reason'))
        named = JointState(name=['joint_6', 'joint_1'], position=[0.3, -0.1])
        publish(JointState, 'goal_joints', named)
        arm.wait_while_driven('the joints', lambda: are_at(arm, joint_1=-0.1, joint_6=0.3))
        arm.wait_while_driven('the end', lambda: arm.motion('result') == 'reached')

    arm.persist(go)


def test_cmd_joints_turns_a_joint_while_it_is_published(arm):
    publisher = arm.node.create_publisher(JointState, 'cmd_joints', COMMAND)
    arm.wait('cmd_joints', lambda: arm.reaches(publisher))

    def has_turned():
        message = JointState(name=['joint_6'], velocity=[0.3])
        message.header.stamp = arm.node.get_clock().now().to_msg()
        publisher.publish(message)
        arm.spin(0.02)
        return arm.motion('mode') == 'jog' and joints(arm)[5] > 0.05

    def jog():
        arm.home()
        arm.wait_while_driven('the joint', has_turned)
        arm.wait_while_driven('rest', lambda: arm.motion('mode') == 'hold')
        assert joints(arm)[5] > 0.05
        arm.wait_while_driven('joint 1', lambda: are_at(arm, joint_1=HOME[0]))

    arm.persist(jog)
    arm.node.destroy_publisher(publisher)  # only one may jog


def test_joint_trajectory_is_executed_and_a_bad_one_is_refused(arm, publish):
    def go():
        back = trajectory((1.0, [0.1, 0.1]), (0.5, [0.2, 0.2]))
        publish(JointTrajectory, 'joint_trajectory', back, is_stamped=False)
        arm.wait('refusal', lambda: 'it must increase' in arm.motion('reason'))
        good = trajectory((1.5, [0.1, -0.2]))
        publish(JointTrajectory, 'joint_trajectory', good, is_stamped=False)
        arm.wait_while_driven('the joints', lambda: are_at(arm, joint_1=0.1, joint_6=-0.2))
        arm.wait_while_driven('the end', lambda: arm.motion('result') == 'reached')

    arm.persist(go)


class Actions:
    """A client of the action, like MoveIt's."""

    def __init__(self, arm):
        from control_msgs.action import FollowJointTrajectory  # noqa: PLC0415 (made by a fixture)

        self.kind, self.arm, self.feedback = FollowJointTrajectory, arm, []
        self.client = ActionClient(
            arm.node, FollowJointTrajectory, 'trajectory/follow_joint_trajectory'
        )
        arm.wait('the action', self.client.server_is_ready)

    def send(self, points, **rest):
        goal = self.kind.Goal(trajectory=points, **rest)
        future = self.client.send_goal_async(goal, lambda m: self.feedback.append(m.feedback))
        self.arm.wait('acceptance', future.done)
        return future.result()

    def result(self, handle):
        future = handle.get_result_async()
        self.arm.wait('result', future.done)
        return future.result().status, future.result().result

    def tolerance(self, name, position, velocity=0.0):
        from control_msgs.msg import JointTolerance  # noqa: PLC0415

        return [JointTolerance(name=name, position=position, velocity=velocity)]


@pytest.fixture
def actions(arm):
    made = Actions(arm)
    yield made
    made.client.destroy()


def test_an_action_reports_feedback_and_succeeds_at_its_end(arm, actions):
    def go():
        begin = np.array(joints(arm))
        actions.feedback.clear()
        handle = actions.send(trajectory((1.5, [0.2, 0.1])))
        status, result = actions.result(handle)
        if status != SUCCEEDED:
            raise Refused(result.error_string)
        assert (result.error_code, result.error_string) == (actions.kind.Result.SUCCESSFUL, '')
        arm.wait_while_driven('the joints', lambda: are_at(arm, joint_1=0.2, joint_6=0.1))
        return begin

    way = np.linspace(arm.persist(go), [0.2, *HOME[1:5], 0.1], 100)
    assert len(actions.feedback) > 5  # how late, is the computer's affair: they are on the way
    for one in actions.feedback:
        assert one.joint_names == list(NAMES)
        error = np.array(one.desired.positions) - np.array(one.actual.positions)
        assert np.abs(error - one.error.positions).max() < 1e-12
        assert np.abs(way - one.actual.positions).max(axis=1).min() < 0.02


def test_a_canceled_action_brakes_and_the_next_one_works(arm, actions):
    def go():
        handle = actions.send(trajectory((20.0, [0.6, 0.0])))
        arm.wait_while_driven('motion', lambda: arm.motion('mode') == 'path')
        arm.spin(0.5)
        future = handle.cancel_goal_async()
        arm.wait('the answer', future.done)
        status, result = actions.result(handle)
        if status != CANCELED:
            raise Refused(f'not canceled: {result.error_string}')
        arm.wait_while_driven('rest', lambda: arm.motion('mode') == 'hold')
        assert joints(arm)[0] < 0.5
        status, result = actions.result(actions.send(trajectory((2.0, [0.0, 0.0]))))
        assert status == SUCCEEDED, result.error_string

    arm.persist(go)


def assert_aborted(ended, code, words):
    status, result = ended
    assert (status, result.error_code) == (ABORTED, code), result.error_string
    assert words in result.error_string


def test_what_ends_an_action_is_told_by_its_code(arm, actions):
    code = actions.kind.Result
    replaced = 'replaced by a newer trajectory'

    def end_of(*points, names=NAMES, **rest):
        return actions.result(actions.send(trajectory(*points, names=names), **rest))

    def go():
        unknown = end_of((1.0, [0.1, 0.1]), names=('elbow', *NAMES[1:]))
        assert_aborted(unknown, code.INVALID_JOINTS, "joint 'elbow' is unknown")
        assert_aborted(end_of((0.1, [1.0, 1.0])), code.INVALID_GOAL, '')
        tight = actions.tolerance('joint_1', 1e-6)
        strict = end_of((2.0, [0.4, 0.0]), path_tolerance=tight)
        assert_aborted(strict, code.PATH_TOLERANCE_VIOLATED, 'joint_1 is')
        first = actions.send(trajectory((30.0, [0.0, 0.0])))
        bad = end_of((1.0, [0.0, np.nan]))
        assert_aborted(bad, code.INVALID_GOAL, 'positions of joint_6 is nan')
        assert first.status == EXECUTING
        slow = actions.tolerance('joint_1', 0.05, 0.01)
        blind = end_of((4.0, [0.1, 0.0]), path_tolerance=slow)
        words = 'velocity in path_tolerance of joint_1 is 0.01'
        assert_aborted(blind, code.INVALID_GOAL, words)
        second = actions.send(trajectory((4.0, [0.1, 0.0])), goal_tolerance=slow)
        assert_aborted(actions.result(first), code.INVALID_GOAL, replaced)
        status, result = actions.result(second)
        assert status == SUCCEEDED, result.error_string
        third = actions.send(trajectory((30.0, [0.5, 0.0])))
        arm.wait_while_driven('motion', lambda: arm.motion('mode') == 'path')
        arm.home()
        assert_aborted(actions.result(third), code.INVALID_GOAL, '')

    arm.persist(go)


def test_a_program_and_the_command_line_move_and_jog_joints(arm, capsys):
    def go():
        with Robot('/arm') as robot:
            robot.move_joints({'joint_6': 0.2}, joint_1=-0.1)
            arm.wait('the joints', lambda: abs(robot.joints['joint_6'] - 0.2) < NEAR)
            robot.jog_joints(joint_6=-0.3, seconds=0.5)
            arm.wait('the jog', lambda: robot.joints['joint_6'] < 0.2 - 2 * NEAR)
            arm.wait('the joints', lambda: abs(robot.joints['joint_1'] + 0.1) < NEAR)
            with pytest.raises(Refused, match='joint_2: joint angle 3 rad outside'):
                robot.move_joints(joint_2=3.0)
        capsys.readouterr()  # of an earlier try
        status = main(['joints', 'arm', '--set', 'joint_6=10', '--units', 'mm', '--json'])
        said = capsys.readouterr().out
        assert status == 0, said
        measured = json.loads(said)['joints']
        assert measured['positions'][5] == pytest.approx(np.radians(10.0), abs=NEAR)
        assert main(['joints', 'arm', '--set', 'elbow=1']) == 2
        assert "--set 'elbow=1': needs NAME=Q, with one of joint_1" in capsys.readouterr().err

    arm.persist(go)
