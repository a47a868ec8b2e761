"""Moves along and about each axis in turn, there and back: the tour of Prokopovich 2019.

    hexarm up hexapod                                    # in another terminal
    python3 examples/axis_tour.py
    python3 examples/axis_tour.py --way 0.004 --angle 0.05

It shows at a glance whether every servo is plugged in where it should be: along x, y and z, then
roll, pitch and yaw about them (right-handed, as REP-103 has it), each to both sides of `--centre`.
The usual amplitudes are within the reach of RoboCake; the first goal that is refused ends the tour
with the leg, the value and the limit.
"""

import argparse
import math
import sys
import time

import rclpy
from publish_pose import LEVEL, Mover

ALONG = ('x', 'y', 'z')
ABOUT = ('roll', 'pitch', 'yaw')


def shifted(centre, axis, way):
    return [value + way * (i == axis) for i, value in enumerate(centre)]


def turned(axis, angle):
    """The quaternion x, y, z, w of a turn about one axis: half the angle's sine and cosine."""
    return [math.sin(angle / 2) * (i == axis) for i in range(3)] + [math.cos(angle / 2)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument(
        '--centre', nargs=3, type=float, default=[0.0, 0.0, 0.04119], help='metres'
    )
    parser.add_argument('--way', type=float, default=0.005, help='along each axis, metres')
    parser.add_argument('--angle', type=float, default=0.1, help='about each axis, radians')
    parser.add_argument('--pause', type=float, default=0.3, help='seconds at each end')
    parser.add_argument('--namespace', default='/hexapod')
    arguments = parser.parse_args()
    centre, way, angle = arguments.centre, arguments.way, arguments.angle

    rclpy.init()
    mover = Mover(rclpy.create_node('axis_tour'), arguments.namespace)
    mover.go_to(centre)
    for axis, name in enumerate(ALONG):
        print(f'{name} ± {1e3 * way:g} mm', flush=True)
        for goal in (shifted(centre, axis, way), shifted(centre, axis, -way), centre):
            mover.go_to(goal)
            time.sleep(arguments.pause)
    for axis, name in enumerate(ABOUT):
        print(f'{name} ± {angle:g} rad', flush=True)
        for goal in (turned(axis, angle), turned(axis, -angle), LEVEL):
            mover.go_to(centre, goal)
            time.sleep(arguments.pause)
    rclpy.shutdown()


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
