"""The reachable pose nearest to one that is out of reach: docs/workspace.md, section 2."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.reach.descent import Descent
from manipulator.reach.joint_descent import nearest_by_joints
from manipulator.reach.metric import distance
from manipulator.reach.way import is_connected, is_joint_box, way_home_share

MOST_STEPS = 60


@dataclass(frozen=True, eq=False)
class Nearest:
    """A reachable pose, and how far it is from the one wanted, in metres (see `metric`)."""

    pose: Pose
    distance: float


def nearest_reachable(machine: Machine, target: Pose, most_steps: int = MOST_STEPS) -> Nearest:
    """The pose nearest to `target` (itself, when it is reachable) that keeps all limits.

    It is admitted and connected to home: both are checked. It is a local minimum of the distance,
    the best of three that are found from the ends of straight ways: from home towards the target,
    towards its position alone, and towards its orientation alone.
    """
    if is_joint_box(machine):
        pose = nearest_by_joints(machine, target)
        return Nearest(pose, float(distance(machine, pose, target)))
    starts = _starts(machine, target)
    ends = [Descent(machine, target, start).run(most_steps) for start in starts]
    found = [(float(distance(machine, pose, target)), k) for k, pose in enumerate(ends)]
    for metres, k in sorted(found):
        if is_connected(machine, ends[k]):
            return Nearest(ends[k], metres)
    return Nearest(starts[0], float(distance(machine, starts[0], target)))


def _starts(machine: Machine, target: Pose) -> list[Pose]:
    """Ends of free ways from home, the straight one first; `target` alone when that is free."""
    home = machine.kinematics.home
    twist: Array = home.twist_to(target)
    straight = way_home_share(machine, target)
    if straight == 1.0:
        return [target]
    starts = [home.moved(straight * twist)]
    for part in (np.repeat([1.0, 0.0], 3), np.repeat([0.0, 1.0], 3)):
        end = home.moved(part * twist)
        starts.append(home.moved(way_home_share(machine, end) * part * twist))
    return starts
