"""Sends a machine to one pose, and waits until it is there, or prints the reason.

    hexarm up hexapod                                    # in another terminal
    python3 examples/publish_pose.py 0.004 0 0.045
    python3 examples/publish_pose.py 0 0 0.045 --rpy 0 0 0.1

`goal_pose` is a geometry_msgs/PoseStamped: metres, a unit quaternion, an empty frame_id means the
machine's base. `motion_status` reports the result of a goal, which it names by its stamp; it is
latched, so that late subscribers receive it. The exit status is 0 for reached, 1 for refused,
stopped or no answer. A slow move may take any time: the wait ends if nothing moves, or nothing
is received, for `--patience` seconds.
"""

import argparse
import sys
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.qos import DurabilityPolicy, QoSProfile

from manipulator.errors import ManipulatorError
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
JOINS_WITHIN = 10.0
"""Seconds that it may take to find the machine's nodes."""

LEVEL = (0.0, 0.0, 0.0, 1.0)


class Mover:
    """Sends goals to one machine and receives their results."""

    def __init__(self, node, namespace, patience=10.0):
        self.node = node
        self.patience = patience
        self.goals = node.create_publisher(PoseStamped, f'{namespace}/goal_pose', 1)
        self.status = DiagnosticStatus()
        node.create_subscription(
            DiagnosticStatus, f'{namespace}/motion_status', self.on_status, LATCHED
        )
        self.setpoint = None
        self.progress_at = 0.0
        node.create_subscription(PoseStamped, f'{namespace}/setpoint', self.on_setpoint, 1)

    def on_status(self, message):
        self.status = message
        self.progress_at = time.monotonic()

    def on_setpoint(self, message):
        """Setpoints come 100 times a second; while the machine moves, each is another pose."""
        if message.pose != self.setpoint:
            self.setpoint = message.pose
            self.progress_at = time.monotonic()

    def publish(self, xyz, quaternion=LEVEL):
        """Publishes a goal, in metres and as x, y, z, w; returns its stamp in seconds."""
        goal = PoseStamped()
        goal.header.stamp = self.node.get_clock().now().to_msg()
        position, orientation = goal.pose.position, goal.pose.orientation
        position.x, position.y, position.z = map(float, xyz)
        orientation.x, orientation.y, orientation.z, orientation.w = map(float, quaternion)
        self.goals.publish(goal)
        return goal.header.stamp.sec + goal.header.stamp.nanosec * 1e-9

    def go_to(self, xyz, quaternion=LEVEL):
        """Publishes a goal and waits for its end; exits with the reason when it is not reached."""
        self.wait(
            self.has_subscribers, f'no machine subscribes to {self.goals.topic_name}', JOINS_WITHIN
        )
        stamp = self.publish(xyz, quaternion)
        self.wait(lambda: self.result(stamp), 'not there, and nothing has moved', self.patience)
        if self.result(stamp) != 'reached':
            sys.exit(self.status.message)

    def has_subscribers(self):
        """Whether all subscribers of goals are connected, the machine among them."""
        subscribers = [
            subscriber
            for subscriber in self.node.get_subscriptions_info_by_topic(self.goals.topic_name)
            if subscriber.qos_profile.durability == DurabilityPolicy.VOLATILE
        ]
        is_there = 'trajectory' in [subscriber.node_name for subscriber in subscribers]
        return is_there and self.goals.get_subscription_count() >= len(subscribers)

    def result(self, stamp):
        """'reached', 'refused' or 'stopped' once the goal of that stamp has ended."""
        values = {pair.key: pair.value for pair in self.status.values}
        if not values or float(values['goal_stamp']) != stamp:
            return None
        return values['result'] if values['result'] != 'moving' else None

    def wait(self, is_so, otherwise, patience):
        """Receives messages until `is_so`; exits when nothing happens for `patience` seconds."""
        begin = time.monotonic()
        while not is_so():
            if time.monotonic() - max(begin, self.progress_at) > patience:
                sys.exit(f'{otherwise} for {patience:g} s')
            rclpy.spin_once(self.node, timeout_sec=0.05)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('xyz', nargs=3, type=float, help='metres, in the base frame')
    parser.add_argument('--rpy', nargs=3, type=float, default=[0, 0, 0], help='radians')
    parser.add_argument('--patience', type=float, default=10.0, help='seconds without motion')
    parser.add_argument('--namespace', default='/hexapod')
    arguments = parser.parse_args()

    try:
        check_turns(arguments.rpy)
    except ManipulatorError as error:
        sys.exit(f'--rpy: {error}')
    quaternion = Pose.from_xyz_rpy(arguments.xyz, arguments.rpy).quaternion

    rclpy.init()
    mover = Mover(rclpy.create_node('publish_pose'), arguments.namespace, arguments.patience)
    mover.go_to(arguments.xyz, quaternion)
    print(mover.status.message)
    rclpy.shutdown()


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
