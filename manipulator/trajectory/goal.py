"""What somebody asks for: a pose, and perhaps a path from there."""

from dataclasses import dataclass

from manipulator.pose import Pose
from manipulator.trajectory.path_timing import TimedPath


@dataclass(frozen=True)
class Goal:
    """A pose to go to, known to its sender by the stamp of his message.

    then: the path to follow from there, whose first pose it is.
    """

    pose: Pose
    stamp: float = 0.0
    then: TimedPath | None = None
