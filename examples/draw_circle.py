"""Draws a level circle by streaming goals, and prints how far off the platform was.

    hexarm up hexapod                                    # in another terminal
    python3 examples/draw_circle.py --radius 0.008 --period 4 --turns 2

A stream of goals needs no answers: each replaces the one before, at any time, and the machine
follows within its limits of speed, acceleration and jerk. The deviation is that of the measured
`pose` from the circle's radius; its lag along the circle does not count. Half of the poses show
how well the machine follows; the worst one also shows whether the computer was busy for a while,
so that the machine caught up straight across the circle.
"""

import argparse
import math
import sys
import time

import rclpy
from geometry_msgs.msg import PoseStamped
from publish_pose import Mover

PERIOD_OF_GOALS = 0.02


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--radius', type=float, default=0.008, help='metres')
    parser.add_argument('--height', type=float, default=0.045, help='metres above the base')
    parser.add_argument('--period', type=float, default=4.0, help='seconds a turn')
    parser.add_argument('--turns', type=float, default=2.0)
    parser.add_argument('--namespace', default='/hexapod')
    arguments = parser.parse_args()

    def point(angle):
        radius = arguments.radius
        return radius * math.cos(angle), radius * math.sin(angle), arguments.height

    rclpy.init()
    node = rclpy.create_node('draw_circle')
    mover = Mover(node, arguments.namespace)
    print('to where the circle begins')
    mover.go_to(point(0.0))

    radii = []

    def on_pose(message):
        position = message.pose.position
        radii.append(math.hypot(position.x, position.y))

    node.create_subscription(PoseStamped, f'{arguments.namespace}/pose', on_pose, 5)
    print(f'{arguments.turns:g} turns of {arguments.period:g} s')
    # Each goal is the next on the circle, however late: a stall must not cut across it.
    for k in range(round(arguments.turns * arguments.period / PERIOD_OF_GOALS)):
        mover.publish(point(2 * math.pi * k * PERIOD_OF_GOALS / arguments.period))
        until = time.monotonic() + PERIOD_OF_GOALS
        while (left := until - time.monotonic()) > 0:
            rclpy.spin_once(node, timeout_sec=left)

    if radii:
        off = sorted(1e3 * abs(radius - arguments.radius) for radius in radii)
        half, worst = off[len(off) // 2], off[-1]
        print(
            f'{len(off)} poses received, half of them within {half:.2f} mm, all within {worst:.2f}'
        )
    rclpy.shutdown()


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
