"""A goal: a pose, how to get there, and the path or cycle to begin there."""

from dataclasses import dataclass, field
from enum import Enum

from manipulator.arrays import Array
from manipulator.planning.cycle import Cycle
from manipulator.planning.orientation import OrientationRule
from manipulator.planning.path_timing import TimedPath
from manipulator.pose import Pose


class Motion(Enum):
    """How a machine at rest goes to a goal; parameter `goal_motion` of the trajectory node."""

    LINE = 'line'
    """Straight, with a turn about one axis, on the branch that the machine is on."""
    JOINT = 'joint'
    """All joints in proportion: to the nearest branch, wherever the tool passes."""
    ANY = 'any'
    """A line where the machine can drive it, else a joint move."""
    UNWIND = 'unwind'
    """All joints in proportion: to home's branch, and the turns nearest to home's."""


class OnUnreachable(Enum):
    """What becomes of a goal out of reach; parameter `on_unreachable` of the trajectory node."""

    REFUSE = 'refuse'
    """It is refused, and the active plan continues."""
    NEAREST = 'nearest'
    """The machine goes to the nearest pose within all limits."""


@dataclass(frozen=True, eq=False)
class Flow:
    """How a stream of goals moves at one of them: twist (6,) and its time derivative (6,).

    Of joints, the rates (n,) and their derivatives.

    due: when to be there; until: when the next goal but one must have come. Both in seconds, on
    the clock of who plans.
    """

    twist: Array
    acceleration: Array
    due: float
    until: float


@dataclass(frozen=True, eq=False)
class Goal:
    """A pose to go to, known to its sender by the stamp of the message.

    then: the path or cycle to drive from there, whose first pose it is, or another goal. joints
    (n,): those to arrive with, None where any of the pose's will do. orientation: where the
    pose's comes from. flow: of the stream of goals that it continues, None where it continues
    none. on_unreachable: see there. received: when, by a monotonic clock, in seconds; 0 where
    that is not known. note: what is reported of it while it is pursued, as that it is the nearest
    pose.
    """

    pose: Pose
    stamp: float = 0.0
    then: 'TimedPath | Cycle | Goal | None' = None
    motion: Motion = Motion.LINE
    joints: Array | None = None
    orientation: OrientationRule = field(default_factory=OrientationRule)
    flow: Flow | None = None
    on_unreachable: OnUnreachable = OnUnreachable.REFUSE
    received: float = 0.0
    note: str = ''
