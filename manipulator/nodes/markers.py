"""The machine as lines, for RViz and Foxglove."""

import time

from builtin_interfaces.msg import Duration, Time
from geometry_msgs.msg import Point
from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from manipulator.arrays import Array
from manipulator.kinematics import Kinematics
from manipulator.nodes.messages import BASE_FRAME
from manipulator.nodes.qos import MEASUREMENT
from manipulator.pose import Pose
from manipulator.skeleton import Stroke

PERIOD = 0.1
LIFETIME = Duration(sec=1)
"""A machine that is no longer heard of disappears."""

COLOURS = {
    'body': (0.35, 0.4, 0.45),
    'crank': (0.82, 0.38, 0.24),
    'rod': (0.04, 0.43, 0.6),
    'platform': (0.42, 0.6, 0.31),
    'link': (0.04, 0.43, 0.6),
}
WIDTH = 0.02
"""Of a line, as part of the machine's height at home."""


class Markers:
    """Publishes `markers`, at most every PERIOD and only while somebody listens."""

    def __init__(self, node: Node, frame_prefix: str) -> None:
        self._frame = frame_prefix + BASE_FRAME
        self._publisher = node.create_publisher(MarkerArray, 'markers', MEASUREMENT)
        self._next = 0.0

    def show(self, kinematics: Kinematics, pose: Pose, joints: Array, stamp: Time) -> None:
        """Shows the machine in its base frame."""
        now = time.monotonic()
        if now < self._next or self._publisher.get_subscription_count() == 0:
            return
        self._next = now + PERIOD
        width = WIDTH * float(kinematics.home.position[2])
        strokes = enumerate(kinematics.skeleton(pose, joints))
        markers = [_marker(k, stroke, width, self._frame, stamp) for k, stroke in strokes]
        self._publisher.publish(MarkerArray(markers=markers))


def _marker(number: int, stroke: Stroke, width: float, frame: str, stamp: Time) -> Marker:
    marker = Marker(ns=stroke.part, id=number, type=Marker.LINE_STRIP, lifetime=LIFETIME)
    marker.header.frame_id, marker.header.stamp = frame, stamp
    marker.pose.orientation.w = 1.0
    marker.scale.x = width
    red, green, blue = COLOURS[stroke.part]
    marker.color = ColorRGBA(r=red, g=green, b=blue, a=1.0)
    marker.points = [Point(x=x, y=y, z=z) for x, y, z in stroke.points.tolist()]
    return marker
