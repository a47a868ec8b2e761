"""From joint states to the pose of the platform or tool, by forward kinematics.

It also publishes the machine as lines, for RViz and Foxglove, and as transforms on /tf where the
package tf2_msgs is installed.
"""

import re
import time
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from builtin_interfaces.msg import Duration, Time
from geometry_msgs.msg import Point, PointStamped, PoseStamped, TransformStamped
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA, String
from visualization_msgs.msg import Marker, MarkerArray

from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import shown
from manipulator.frames import Frames
from manipulator.kinematics import Kinematics
from manipulator.links import Link, Stroke
from manipulator.machine import Machine
from manipulator.nodes.diagnostics import OK, WARN, Diagnostics, Report
from manipulator.nodes.intra_process import IntraProcess
from manipulator.nodes.messages import (
    BASE_FRAME,
    PIVOT_FRAME,
    PLATFORM_FRAME,
    WORK_FRAME,
    known_joints,
    point_of,
    pose_message,
)
from manipulator.nodes.parameters import declare
from manipulator.nodes.qos import COMMAND, MEASUREMENT
from manipulator.nodes.saved_pose_topics import SavedPoseTopics
from manipulator.nodes.subscriptions import FilteredCallback
from manipulator.pose import Pose
from manipulator.pose_estimate import PoseEstimate

PERIOD = 0.1
LIFETIME = Duration(sec=1)
"""A machine whose pose is no longer published disappears."""

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
    """Publishes `markers`, at most every PERIOD and only while there is a subscriber."""

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
        width = WIDTH * kinematics.characteristic_length
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


TF_QOS = QoSProfile(depth=100)
"""The quality of service that every tf2 listener requests."""


def declare_prefix(node: Node) -> str:
    """The parameter `frame_prefix`; InvalidInput for what tf2 would not accept."""
    meaning = 'prefix of the frame names of tf and markers, as in hexapod/'
    prefix = str(declare(node, 'frame_prefix', '', meaning))
    if re.fullmatch(r'([A-Za-z_][\w/-]*)?', prefix, re.ASCII) is None:
        raise InvalidInput(
            f'parameter frame_prefix: {shown(prefix)} is not a valid prefix of a frame name'
        )
    return prefix


class Transforms:
    """Publishes /tf while there is a subscriber; without tf2_msgs it does nothing."""

    def __init__(self, node: Node, prefix: str) -> None:
        self._prefix = prefix
        try:
            self._kind: Any = import_module('tf2_msgs.msg').TFMessage
        except ModuleNotFoundError:
            self._kind = None
            return
        self._publisher = node.create_publisher(self._kind, '/tf', TF_QOS)

    def show(
        self, kinematics: Kinematics, frames: Frames, pose: Pose, joints: Array, stamp: Time
    ) -> None:
        """Publishes every frame of the machine."""
        if self._kind is None or self._publisher.get_subscription_count() == 0:
            return
        entries = transforms(kinematics.links(pose, joints), frames, self._prefix, stamp)
        self._publisher.publish(self._kind(transforms=entries))


def transforms(
    links: Sequence[Link], frames: Frames, prefix: str, stamp: Time
) -> list[TransformStamped]:
    """Base to every link and to the work frame, platform to pivot."""
    entries = [(BASE_FRAME, link.name, link.pose) for link in links]
    entries.append((BASE_FRAME, WORK_FRAME, frames.T_base_work))
    entries.append((PLATFORM_FRAME, PIVOT_FRAME, frames.T_platform_pivot))
    return [
        _transform(prefix + parent, prefix + child, pose, stamp) for parent, child, pose in entries
    ]


def _transform(parent: str, child: str, pose: Pose, stamp: Time) -> TransformStamped:
    message = TransformStamped(child_frame_id=child)
    message.header.stamp, message.header.frame_id = stamp, parent
    shift, turn = message.transform.translation, message.transform.rotation
    shift.x, shift.y, shift.z = pose.position.tolist()
    turn.x, turn.y, turn.z, turn.w = pose.quaternion.tolist()
    return message


class PoseNode(Node):
    """joint_states in, pose out while all joints are known; see docs/interfaces.md.

    saved_poses: the file of a machine's saved poses, by the machine's name or path.
    """

    def __init__(
        self,
        load: Callable[[str], Machine],
        saved_poses: Callable[[str], Path],
        default_machine: str,
        process: IntraProcess,
    ) -> None:
        super().__init__('pose')
        name = declare(self, 'machine', default_machine, 'machine file: a shipped name or a path')
        machine = load(name)
        self._kinematics, self._frames = machine.kinematics, machine.frames
        self._names = machine.kinematics.joint_names
        self._estimate = PoseEstimate(machine, self.get_logger().info)
        self._states = FilteredCallback(self, 'joint_states', self._on_joint_states)
        self._publisher = process.publisher(self, PoseStamped, 'pose', MEASUREMENT)
        prefix = declare_prefix(self)
        self._markers = Markers(self, prefix)
        self._transforms = Transforms(self, prefix)
        self._pivot_publisher = self.create_publisher(PoseStamped, 'pivot_pose', MEASUREMENT)
        self.create_subscription(PointStamped, 'pivot', self._on_pivot, COMMAND)
        self.create_subscription(String, 'tool', self._on_tool, COMMAND)
        process.subscribe(self, JointState, 'joint_states', self._states, MEASUREMENT)
        self._saved = SavedPoseTopics(self, machine, saved_poses(name))
        self._diagnostics = Diagnostics(self, self._report, ('joint_states', 'pose'))

    def _on_joint_states(self, message: JointState) -> None:
        joints = known_joints(message, self._names)
        solution = self._estimate.update(joints)
        if solution is None or joints is None:
            return
        pose, stamp = solution.pose, message.header.stamp
        self._publisher.publish(pose_message(pose, stamp))
        self._saved.note(pose, joints)
        self._markers.show(self._kinematics, pose, joints, stamp)
        self._transforms.show(self._kinematics, self._frames, pose, joints, stamp)
        if self._pivot_publisher.get_subscription_count() > 0:
            in_work = pose_message(self._frames.pivot(pose), stamp, WORK_FRAME)
            self._pivot_publisher.publish(in_work)

    def _on_pivot(self, message: PointStamped) -> None:
        try:
            self._frames = self._frames.with_pivot(point_of(message, PLATFORM_FRAME))
        except InvalidInput as error:
            self.get_logger().warning(f'pivot: {error}', throttle_duration_sec=1.0)

    def _on_tool(self, message: String) -> None:
        try:
            self._frames = self._frames.with_tool(message.data)
        except InvalidInput as error:
            self.get_logger().warning(f'tool: {error}', throttle_duration_sec=1.0)

    def _report(self) -> Report:
        values: dict[str, object] = {
            'last_joint_state_age_s': self._states.age,
            'joint_states_refused': self._states.refused,
            'last_refusal': self._states.last_refusal,
        }
        problem = self._saved.watch()
        solution = self._estimate.solution
        if solution is None:
            return _level(problem), problem or 'no joint states', values
        values['singularity_margin'] = solution.sigma_min
        values['residual_mm'] = solution.residual * 1e3
        values['iterations'] = solution.iterations
        return _level(problem), problem or 'running', values


def _level(problem: str) -> Any:
    return WARN if problem else OK
