"""`goal_path`: received in a process of its own, timed by the worker, then driven like a goal."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from math import radians

from builtin_interfaces.msg import Time
from nav_msgs.msg import Path
from rclpy.node import Node
from std_msgs.msg import Header

from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError, Refused
from manipulator.machine import Machine
from manipulator.nodes.graph_check import Received
from manipulator.nodes.intake import Intake
from manipulator.nodes.messages import BASE_FRAME, WORK_FRAME, check_frame, pose_message, seconds
from manipulator.nodes.parameters import declare
from manipulator.nodes.path_cdr import read_poses
from manipulator.nodes.path_ear import PathEar
from manipulator.nodes.path_listener import MOST_POSES, HeardPath
from manipulator.nodes.qos import COMMAND
from manipulator.pose import Pose
from manipulator.trajectory.early_command import EarlyCommand
from manipulator.trajectory.goal import Goal
from manipulator.trajectory.motion_status import MotionStatus
from manipulator.trajectory.path import Tolerance
from manipulator.trajectory.path_timing import PathRequest, TimedPath, plan_path
from manipulator.trajectory.pilot import Pilot
from manipulator.trajectory.player import Player
from manipulator.trajectory.worker import Effort, Job, Worker
from manipulator.words import counted

OVERTAKEN = 'a newer command came while the path was worked out'


GOAL_PATH = Received('goal_path', Path, COMMAND)
"""What the process of path_listener receives."""


@dataclass(frozen=True)
class RawPath:
    """A path of which only the beginning has been read."""

    header: Header
    count: int
    serialized: bytes


@dataclass(frozen=True, eq=False)
class PathTask:
    """A serialized nav_msgs/Path in `frame`, and who is to drive it from joints `near` (n,)."""

    machine: Machine
    serialized: bytes
    frame: str
    speed: float
    tolerance: Tolerance
    near: Array
    dt: float

    def planned(self, effort: Effort) -> TimedPath | Pose:
        """See `plan_path`; poses of the platform are turned into those of the pivot."""
        poses, stamps = read_poses(self.serialized, self.frame)
        if self.frame == BASE_FRAME:
            poses = self.machine.frames.pivot(poses)
        request = PathRequest(poses, self.speed, self.tolerance, stamps)
        return plan_path(self.machine, request, self.near, self.dt, effort)


class PathGoals:
    """The path that is being worked out, if any; `poll` is called at every tick."""

    def __init__(
        self,
        node: Node,
        pilot: Pilot,
        early: EarlyCommand,
        dt: float,
        worker: Worker,
        say: Callable[[MotionStatus], None],
    ) -> None:
        self._node, self._pilot, self._dt, self._say = node, pilot, dt, say
        self._early, self._worker = early, worker
        self._work: Job[TimedPath | Pose] | None = None
        self._stamp = 0.0
        fastest = pilot.machine.motion.linear.speed
        for name, default, description, bounds in (
            ('path_speed', fastest, 'speed along paths without stamps (m/s)', (1e-4, 10.0)),
            ('path_tolerance', 1e-4, 'how far a path may cut its corners (m)', (1e-6, 0.1)),
            ('path_turn_tolerance', radians(0.1), 'the same for turns (rad)', (1e-5, 0.2)),
        ):
            declare(node, name, default, description, bounds, is_read_only=False)
        self._intake = Intake(node, 'goal_path', self._on_path, self._on_bad_path)
        self._ear = PathEar(node.get_namespace(), node.resolve_topic_name('goal_path'))

    def poll(self) -> None:
        """Takes up what was heard or has been worked out; drops it when something newer came."""
        message = self._ear.take()
        if message is not None:
            self._intake(_raw_path(message))
        if self._work is None:
            return
        if not self._is_expected:
            self._cancel()
            self._say(MotionStatus(self._pilot.status.mode, 'stopped', self._stamp, OVERTAKEN))
            return
        if self._work.is_done:
            work, self._work = self._work, None
            self._take(work, self._pilot.player)

    def close(self) -> None:
        """Ends the process that receives paths."""
        self._cancel()
        self._ear.close()

    def _take(self, work: 'Job[TimedPath | Pose]', player: Player) -> None:
        try:
            outcome = work.result()
        except ManipulatorError as error:
            player.refuse(self._stamp, str(error))
            return
        if isinstance(outcome, Pose):
            player.pursue(Goal(outcome, self._stamp))
        else:
            player.pursue(Goal(outcome.at(0.0).pose, self._stamp, then=outcome))

    def _cancel(self) -> None:
        if self._work is not None:
            self._work.cancel()
            self._work = None

    @property
    def _is_expected(self) -> bool:
        try:
            return self._pilot.player.expected == self._stamp
        except Refused:
            return False

    def _on_path(self, message: RawPath) -> None:
        if not 1 <= message.count <= MOST_POSES:
            raise InvalidInput(
                f'a path of {counted(message.count, "pose")}, needs 1 to {MOST_POSES}'
            )
        if not message.serialized:
            raise InvalidInput(
                f'a path of {counted(message.count, "pose")}, and yet of too many bytes'
            )
        check_frame(message.header.frame_id, (BASE_FRAME, WORK_FRAME))
        self._early.take(
            lambda: self._work_out(message),
            lambda error: self._intake.refuse(message, error),
            time.monotonic(),
        )

    def _work_out(self, message: RawPath) -> None:
        frame = message.header.frame_id or BASE_FRAME
        player, stamp = self._pilot.player, seconds(message.header.stamp)
        task = PathTask(
            self._pilot.machine,
            message.serialized,
            frame,
            self._parameter('path_speed'),
            Tolerance(self._parameter('path_tolerance'), self._parameter('path_turn_tolerance')),
            player.joints,
            self._dt,
        )
        player.expect(stamp)
        self._cancel()
        try:
            self._stamp, self._work = stamp, self._worker.submit(task.planned)
        except Refused as error:
            player.refuse(stamp, str(error))

    def _parameter(self, name: str) -> float:
        return float(self._node.get_parameter(name).value)

    def _on_bad_path(self, message: RawPath, error: ManipulatorError) -> None:
        mode, stamp = self._pilot.status.mode, seconds(message.header.stamp)
        self._say(MotionStatus(mode, 'refused', stamp, str(error)))


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
