"""The machine as transforms on /tf, where the package tf2_msgs is installed."""

import re
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import QoSProfile

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.frames import Frames
from manipulator.kinematics import Kinematics
from manipulator.links import Link
from manipulator.nodes.messages import BASE_FRAME, PIVOT_FRAME, PLATFORM_FRAME, WORK_FRAME
from manipulator.nodes.parameters import declare
from manipulator.pose import Pose
from manipulator.words import shown

LISTENED = QoSProfile(depth=100)
"""What every tf2 listener asks for."""


def declare_prefix(node: Node) -> str:
    """The parameter `frame_prefix`; InvalidInput for what tf2 would not accept."""
    meaning = 'stands before the frame names of tf and markers, as in hexapod/'
    prefix = str(declare(node, 'frame_prefix', '', meaning))
    if re.fullmatch(r'([A-Za-z_][\w/-]*)?', prefix, re.ASCII) is None:
        raise InvalidInput(
            f'parameter frame_prefix: {shown(prefix)} is no beginning of a frame name'
        )
    return prefix


class Transforms:
    """Publishes /tf while somebody listens; without tf2_msgs it does nothing, and says nothing."""

    def __init__(self, node: Node, prefix: str) -> None:
        self._prefix = prefix
        try:
            self._kind: Any = import_module('tf2_msgs.msg').TFMessage
        except ModuleNotFoundError:
            self._kind = None
            return
        self._publisher = node.create_publisher(self._kind, '/tf', LISTENED)

    def show(
        self, kinematics: Kinematics, frames: Frames, pose: Pose, joints: Array, stamp: Time
    ) -> None:
        """Tells where every frame of the machine is."""
        if self._kind is None or self._publisher.get_subscription_count() == 0:
            return
        told = transforms(kinematics.links(pose, joints), frames, self._prefix, stamp)
        self._publisher.publish(self._kind(transforms=told))


def transforms(
    links: Sequence[Link], frames: Frames, prefix: str, stamp: Time
) -> list[TransformStamped]:
    """Base to every link and to the work frame, platform to pivot."""
    told = [(BASE_FRAME, link.name, link.pose) for link in links]
    told.append((BASE_FRAME, WORK_FRAME, frames.T_base_work))
    told.append((PLATFORM_FRAME, PIVOT_FRAME, frames.T_platform_pivot))
    return [
        _transform(prefix + parent, prefix + child, pose, stamp) for parent, child, pose in told
    ]


def _transform(parent: str, child: str, pose: Pose, stamp: Time) -> TransformStamped:
    message = TransformStamped(child_frame_id=child)
    message.header.stamp, message.header.frame_id = stamp, parent
    shift, turn = message.transform.translation, message.transform.rotation
    shift.x, shift.y, shift.z = pose.position.tolist()
    turn.x, turn.y, turn.z, turn.w = pose.quaternion.tolist()
    return message
