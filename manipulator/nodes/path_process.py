"""Working a path out in a process of its own, beside the command loop; knows no ROS.

One task comes pickled on standard input, its result goes pickled to standard output.
"""

import os
import pickle
import sys
from dataclasses import dataclass, replace

from manipulator.arrays import Array
from manipulator.errors import ManipulatorError, Refused
from manipulator.machine import Machine
from manipulator.nodes.path_cdr import read_poses
from manipulator.pose import Pose
from manipulator.teleop.jogger import Jogger
from manipulator.trajectory.path import Tolerance
from manipulator.trajectory.path_timing import PathRequest, TimedPath, plan_path

NICENESS = 10


@dataclass(frozen=True, eq=False)
class PathTask:
    """A serialized nav_msgs/Path in `frame`, and who is to drive it from joints `near`."""

    machine: Machine
    serialized: bytes
    frame: str
    is_of_platform: bool
    speed: float
    tolerance: Tolerance
    near: Array
    dt: float

    @property
    def pickled(self) -> bytes:
        """As it goes to the process: without the jogger, which no path needs."""
        return pickle.dumps(replace(self, machine=replace(self.machine, make_jogger=no_jogger)))

    def result(self) -> TimedPath | Pose:
        """See plan_path; poses of the platform are turned into those of the pivot."""
        poses, stamps = read_poses(self.serialized, self.frame)
        if self.is_of_platform:
            poses = self.machine.frames.pivot(poses)
        request = PathRequest(poses, self.speed, self.tolerance, stamps)
        return plan_path(self.machine, request, self.near, self.dt)


def no_jogger(machine: Machine) -> Jogger:
    """What a machine in this process has for a jogger."""
    raise Refused('a path is not jogged')


def main() -> None:
    """Reads a task, writes a TimedPath, a Pose or, as a text, why there is none."""
    os.nice(NICENESS)
    task: PathTask = pickle.load(sys.stdin.buffer)
    try:
        result: TimedPath | Pose | str = task.result()
    except ManipulatorError as error:
        result = str(error)
    pickle.dump(result, sys.stdout.buffer)
