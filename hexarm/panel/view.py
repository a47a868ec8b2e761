"""What the page shows of a machine at one moment."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from manipulator.arrays import Array
from manipulator.frames import Frames
from manipulator.pose import Pose
from manipulator.saved_poses import SavedPose
from manipulator.states import UNKNOWN


@dataclass(frozen=True, eq=False)
class Stance:
    """One pose of the platform or tool in the base frame, and the joints that go with it.

    opening is the gripper's, 0 closed to 1 open, where there is one and it is known.
    """

    pose: Pose
    joints: Array
    opening: float | None = None


@dataclass(frozen=True)
class NodeReport:
    """One node's last report on /diagnostics; age in seconds, level 0 (good) to 3."""

    name: str
    level: int
    message: str
    values: Mapping[str, str]
    age: float


@dataclass(frozen=True, eq=False)
class View:
    """Measured and commanded stance (None while nothing fresh is known), texts, saved poses."""

    measured: Stance | None = None
    commanded: Stance | None = None
    frames: Frames = field(default_factory=Frames)
    machine_state: str = UNKNOWN
    machine_reason: str = ''
    mode: str = ''
    motion: str = ''
    nodes: tuple[NodeReport, ...] = ()
    saved: Mapping[str, SavedPose] = field(default_factory=dict)
