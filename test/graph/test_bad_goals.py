"""Goals from clocks that are off, out of order, too many, and from two at once."""

import time

import pytest
from geometry_msgs.msg import PoseStamped

from manipulator.nodes.messages import pose_message
from manipulator.nodes.qos import COMMAND
from manipulator.pose import Pose

pytestmark = pytest.mark.graph


class Sender:
    """Publishes goals with stamps of its own making."""

    def __init__(self, user):
        self.user = user
        self.publisher = user.node.create_publisher(PoseStamped, 'goal_pose', COMMAND)
        user.wait('a listener', lambda: self.publisher.get_subscription_count() > 0, 10.0)

    def send(self, x, clock=0.0):
        stamp = self.user.node.get_clock().now().to_msg()
        stamp.sec += int(clock)
        stamp.nanosec = min(max(stamp.nanosec + int(clock % 1 * 1e9), 0), 999_999_999)
        message = pose_message(Pose.from_xyz_rpy((x, 0.0, 0.044)), stamp)
        self.publisher.publish(message)
        return f'{stamp.sec + stamp.nanosec * 1e-9:.9f}'

    def drive(self, x):
        stamp = self.send(x)
        self.user.wait(f'x = {x}', lambda: self.is_reached(stamp), 10.0)

    def is_reached(self, stamp):
        return self.user.motion('goal_stamp') == stamp and self.user.motion('result') == 'reached'


@pytest.fixture
def sender(enabled):
    enabled.home()
    return Sender(enabled)


def test_old_goal_is_refused_and_the_next_one_works(sender):
    sender.drive(0.002)
    old = sender.send(0.006, clock=-30.0)
    sender.user.wait('a refusal', lambda: sender.user.motion('goal_stamp') == old, 5.0)
    assert 's old, at most 0.5 s' in sender.user.motion_status.message
    sender.drive(0.003)


@pytest.mark.parametrize('clock', [-3600.0, 3600.0])
def test_source_whose_clock_is_off_by_an_hour_is_believed_with_its_second_goal(sender, clock):
    for x in (0.001, 0.004):
        stamp = sender.send(x, clock)
        sender.user.spin(0.2)
    sender.user.wait('the goal', lambda: sender.is_reached(stamp), 10.0)


def test_goals_at_2_khz_are_pursued_newest_first_and_the_loop_goes_on(sender):
    setpoints = []
    sender.user.node.create_subscription(PoseStamped, 'setpoint', setpoints.append, COMMAND)
    sender.user.wait('setpoints', lambda: len(setpoints) > 5, 10.0)
    setpoints.clear()
    begin = time.monotonic()
    for k in range(2000):
        stamp = sender.send(0.008 * k / 2000)
        sender.user.spin(max(0.0, begin + k / 2000 - time.monotonic()))
    sender.user.wait('the last goal', lambda: sender.is_reached(stamp), 10.0)
    assert len(setpoints) > 20
    sender.drive(0.001)


def test_second_publisher_of_an_internal_topic_is_said(enabled):
    intruder = enabled.node.create_publisher(PoseStamped, 'setpoint', COMMAND)
    words = '2 publishers on setpoint, which must have one'

    def is_said():
        found = enabled.diagnostics.get('hexapod/ik')
        return found is not None and words in found.message

    enabled.wait('a warning', is_said, 10.0)
    enabled.node.destroy_publisher(intruder)
    enabled.wait('its end', lambda: not is_said(), 10.0)
