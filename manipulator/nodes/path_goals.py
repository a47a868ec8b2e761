"""`goal_path`: received in a process of its own, handed to the supervisor still serialized."""

import time
from dataclasses import dataclass
from functools import partial
from math import radians

from builtin_interfaces.msg import Time
from nav_msgs.msg import Path
from rclpy.node import Node
from std_msgs.msg import Header

from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.nodes.graph_check import Received
from manipulator.nodes.intake import Intake
from manipulator.nodes.messages import BASE_FRAME, WORK_FRAME, check_frame, pose_message, seconds
from manipulator.nodes.parameters import declare
from manipulator.nodes.path_cdr import read_poses
from manipulator.nodes.path_ear import PathEar
from manipulator.nodes.path_listener import MOST_POSES, HeardPath
from manipulator.nodes.qos import COMMAND
from manipulator.pose import Pose
from manipulator.trajectory.path import Tolerance
from manipulator.trajectory.path_planning import PathGoal
from manipulator.trajectory.path_timing import PathRequest
from manipulator.trajectory.supervisor import Supervisor
from manipulator.words import counted

GOAL_PATH = Received('goal_path', Path, COMMAND)
"""What the process of path_listener receives."""


@dataclass(frozen=True)
class RawPath:
    """A path of which only the beginning has been read."""

    header: Header
    count: int
    serialized: bytes


class PathGoals:
    """The topic and its parameters; `poll` is called at every tick."""

    def __init__(self, node: Node, supervisor: Supervisor) -> None:
        self._node, self._supervisor = node, supervisor
        fastest = supervisor.pilot.machine.motion.linear.speed
        for name, default, description, bounds in (
            ('path_speed', fastest, 'speed along paths without stamps (m/s)', (1e-4, 10.0)),
            ('path_tolerance', 1e-4, 'how far a path may cut its corners (m)', (1e-6, 0.1)),
            ('path_turn_tolerance', radians(0.1), 'the same for turns (rad)', (1e-5, 0.2)),
        ):
            declare(node, name, default, description, bounds, is_read_only=False)
        self._intake = Intake(node, 'goal_path', self._on_path, self._on_bad_path)
        self._ear = PathEar(node.get_namespace(), node.resolve_topic_name('goal_path'))

    def poll(self) -> None:
        """Takes up what was heard since the last tick."""
        message = self._ear.take()
        if message is not None:
            self._intake(_raw_path(message))

    def close(self) -> None:
        """Ends the process that receives paths."""
        self._ear.close()

    def _on_path(self, message: RawPath) -> None:
        poses = counted(message.count, 'pose')
        if not 1 <= message.count <= MOST_POSES:
            raise InvalidInput(f'a path of {poses}, needs 1 to {MOST_POSES}')
        if not message.serialized:
            raise InvalidInput(f'a path of {poses}, and yet of too many bytes')
        check_frame(message.header.frame_id, (BASE_FRAME, WORK_FRAME))
        self._supervisor.follow(
            self._goal_of(message),
            lambda error: self._intake.refuse(message, error),
            time.monotonic(),
        )

    def _goal_of(self, message: RawPath) -> PathGoal:
        frame = message.header.frame_id or BASE_FRAME
        tolerance = Tolerance(
            self._parameter('path_tolerance'), self._parameter('path_turn_tolerance')
        )
        read = partial(
            _request, message.serialized, frame, self._parameter('path_speed'), tolerance
        )
        return PathGoal(seconds(message.header.stamp), read, is_of_platform=frame == BASE_FRAME)

    def _parameter(self, name: str) -> float:
        return float(self._node.get_parameter(name).value)

    def _on_bad_path(self, message: RawPath, error: ManipulatorError) -> None:
        self._supervisor.refuse(seconds(message.header.stamp), error)


def _request(serialized: bytes, frame: str, speed: float, tolerance: Tolerance) -> PathRequest:
    poses, stamps = read_poses(serialized, frame)
    return PathRequest(poses, speed, tolerance, stamps)


def _raw_path(message: HeardPath) -> RawPath:
    stamp = Time(sec=message.head.sec, nanosec=message.head.nanosec)
    header = Header(stamp=stamp, frame_id=message.head.frame_id)
    return RawPath(header, message.head.count, message.serialized)


def path_message(
    poses: Pose, stamp: Time, frame: str = BASE_FRAME, stamps: list[Time] | None = None
) -> Path:
    """Poses (n,) as a message; their stamps, if any, say when each is to be passed."""
    count = len(poses.position)
    times = [Time()] * count if stamps is None else stamps
    message = Path(poses=[pose_message(poses[i], times[i], frame) for i in range(count)])
    message.header.stamp, message.header.frame_id = stamp, frame
    return message
