"""`goal_path`: judged by its length and its header in the tick, decoded in the planning thread.

Decoding 2,000 poses costs 30 to 50 ms of a core: several ticks, and the planning thread has the
time. What is longer than the longest path is refused by its length, and never decoded.
"""

import time
from functools import partial
from math import radians
from operator import attrgetter

import numpy as np
from builtin_interfaces.msg import Time
from nav_msgs.msg import Path
from rclpy.node import Node

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.formatting import counted, shown
from manipulator.nodes.messages import (
    BASE_FRAME,
    NO_TURN,
    WORK_FRAME,
    check_frame,
    pose_message,
    seconds,
)
from manipulator.nodes.parameters import GoalParameters, declare
from manipulator.nodes.qos import COMMAND
from manipulator.nodes.subscriptions import FilteredCallback, RawMessage, decoded, raw_message
from manipulator.planning.path import Tolerance
from manipulator.planning.path_timing import PathRequest
from manipulator.pose import Pose
from manipulator.trajectory.controller import MotionController
from manipulator.trajectory.path_planning import PathGoal

MOST_POSES = 2000
MOST_BYTES = 100 * MOST_POSES
"""Of a serialized path: a pose takes 68 bytes and its frame_id, at most 80 together."""

NUMBERS = ('x', 'y', 'z', 'qx', 'qy', 'qz', 'qw')
POSITION, ORIENTATION = attrgetter(*'xyz'), attrgetter(*'xyzw')


class PathGoals:
    """The topic and its parameters."""

    def __init__(
        self, node: Node, controller: MotionController, parameters: GoalParameters
    ) -> None:
        self._node, self._controller, self._parameters = node, controller, parameters
        fastest = controller.supervisor.machine.motion.linear.speed
        for name, default, description, bounds in (
            ('path_speed', fastest, 'speed along paths without stamps (m/s)', (1e-4, 10.0)),
            ('path_tolerance', 1e-4, 'how far a path may cut its corners (m)', (1e-6, 0.1)),
            ('path_turn_tolerance', radians(0.1), 'the same for turns (rad)', (1e-5, 0.2)),
        ):
            declare(node, name, default, description, bounds, is_read_only=False)
        self._receive = FilteredCallback(node, 'goal_path', self._on_path, self._on_bad_path)
        node.create_subscription(
            Path,
            'goal_path',
            lambda raw: self._receive(raw_message(raw, MOST_BYTES)),
            COMMAND,
            raw=True,
        )

    def _on_path(self, message: RawMessage) -> None:
        length = len(message.serialized)
        if length > MOST_BYTES:
            raise InvalidInput(
                f'a path of {length:,} bytes, limit {MOST_BYTES:,}: {MOST_POSES:,} poses take less'
            )
        check_frame(message.header.frame_id, (BASE_FRAME, WORK_FRAME))
        self._controller.follow(
            self._goal_of(message),
            lambda error: self._receive.refuse(message, error),
            time.monotonic(),
        )

    def _goal_of(self, message: RawMessage) -> PathGoal:
        frame = message.header.frame_id or BASE_FRAME
        tolerance = Tolerance(
            self._parameter('path_tolerance'), self._parameter('path_turn_tolerance')
        )
        is_of_platform = frame == BASE_FRAME
        rule = self._controller.orientation_rule(self._parameters.orientation, is_of_platform)
        speed = self._parameter('path_speed')
        read = partial(_request, message.serialized, speed, tolerance, rule.is_given)
        return PathGoal(seconds(message.header.stamp), read, is_of_platform, rule)

    def _parameter(self, name: str) -> float:
        return float(self._node.get_parameter(name).value)

    def _on_bad_path(self, message: RawMessage, error: ManipulatorError) -> None:
        self._controller.refuse(seconds(message.header.stamp), error)


def _request(
    serialized: bytes, speed: float, tolerance: Tolerance, are_oriented: bool
) -> PathRequest:
    poses, stamps = path_of(decoded(serialized, Path, MOST_BYTES), are_oriented)
    return PathRequest(poses, speed, tolerance, stamps)


def path_of(message: Path, are_oriented: bool = True) -> tuple[Pose, Array | None]:
    """Poses (n,) and their stamps (n,), in seconds from the first; None where all are equal.

    Raises InvalidInput for too few or many poses; naming the pose, for numbers that are not
    finite, quaternions that are no rotation, frames that are neither empty nor the path's, and
    stamps that do not all increase. Quaternions of zeros are allowed where the poses are not
    oriented.
    """
    count, frame = len(message.poses), message.header.frame_id or BASE_FRAME
    if not 1 <= count <= MOST_POSES:
        raise InvalidInput(f'a path of {counted(count, "pose")}, needs 1 to {MOST_POSES:,}')
    stamps, values = np.empty((count, 2), dtype=np.int64), np.empty((count, 7))
    for i, stamped in enumerate(message.poses):
        name, stamp = stamped.header.frame_id, stamped.header.stamp
        if name not in ('', frame):
            raise InvalidInput(
                f'pose {i + 1}: frame_id {shown(name)}, the path is in {shown(frame)}'
            )
        stamps[i] = stamp.sec, stamp.nanosec
        values[i, :3] = POSITION(stamped.pose.position)
        values[i, 3:] = ORIENTATION(stamped.pose.orientation)
    if not are_oriented:
        values[~values[:, 3:].any(axis=1), 3:] = NO_TURN
    return _poses(values), _seconds(stamps)


def _poses(values: Array) -> Pose:
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        i, k = bad[0]
        raise InvalidInput(f'pose {i + 1}: {NUMBERS[k]} is {values[i, k]}, not a finite number')
    lengths = np.linalg.norm(values[:, 3:], axis=1)
    odd = np.flatnonzero(np.abs(lengths - 1.0) > so3.UNIT_TOLERANCE)
    if len(odd):
        i = odd[0]
        raise InvalidInput(
            f'pose {i + 1}: quaternion has length {lengths[i]:.6g}, a rotation needs 1 ± 0.001'
        )
    return Pose.from_xyz_quaternion(values[:, :3], values[:, 3:])


def _seconds(stamps: 'np.ndarray[tuple[int, ...], np.dtype[np.int64]]') -> Array | None:
    if (stamps == stamps[0]).all():
        return None
    since = stamps - stamps[0]
    seconds: Array = since[:, 0] + 1e-9 * since[:, 1]
    back = np.flatnonzero(np.diff(seconds) <= 0)
    if len(back):
        raise InvalidInput(
            f'pose {back[0] + 2}: its stamp is not after that of pose {back[0] + 1}: stamps must '
            'all increase, or all be the same'
        )
    return seconds


def path_message(
    poses: Pose, stamp: Time, frame: str = BASE_FRAME, stamps: list[Time] | None = None
) -> Path:
    """Poses (n,) as a message; their stamps, if any, are the times to pass them."""
    count = len(poses.position)
    times = [Time()] * count if stamps is None else stamps
    message = Path(poses=[pose_message(poses[i], times[i], frame) for i in range(count)])
    message.header.stamp, message.header.frame_id = stamp, frame
    return message
