"""Prints where the joints are, until Ctrl-C or `--count` lines.

    hexarm up hexapod                                    # in another terminal
    python3 examples/watch_joints.py

`joint_states` is the usual sensor_msgs/JointState: names and positions, in radians (metres for
linear legs). A hobby servo reports nothing, so these are the positions that the board last put
out; after power-up nobody knows where the servos stand, and until they are enabled there are none.
"""

import argparse
import time

import rclpy
from sensor_msgs.msg import JointState


class Watcher:
    """Prints some of the messages that it hears."""

    def __init__(self, seconds_between):
        self.lines = 0
        self.seconds_between = seconds_between
        self.printed_at = float('-inf')

    def on_joints(self, message):
        now = time.monotonic()
        if now < self.printed_at + self.seconds_between:
            return
        if not self.lines:
            print('  '.join(f'{name:>9}' for name in message.name), flush=True)
        print('  '.join(f'{position:9.4f}' for position in message.position), flush=True)
        self.lines += 1
        self.printed_at = now


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--count', type=float, default=float('inf'), help='lines, then end')
    parser.add_argument('--every', type=float, default=0.2, help='seconds between lines')
    parser.add_argument('--namespace', default='/hexapod')
    arguments = parser.parse_args()

    rclpy.init()
    node = rclpy.create_node('watch_joints')
    watcher = Watcher(arguments.every)
    node.create_subscription(
        JointState, f'{arguments.namespace}/joint_states', watcher.on_joints, 5
    )
    try:
        while watcher.lines < arguments.count:
            rclpy.spin_once(node, timeout_sec=0.1)
    except KeyboardInterrupt:
        print()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
