"""Paths between poses: whether they are free, and whether one leads from home."""

import numpy as np

from manipulator.analysis.readings import CHECKS_PER_LENGTH, displaced, distance, offset
from manipulator.analysis.slope import nearest_point, slopes
from manipulator.arrays import Array, Mask
from manipulator.limits.limit import Grouped
from manipulator.limits.machine_limits import JointRange
from manipulator.machine import Machine
from manipulator.pose import Pose

INSIDE = 3e-3  # how far inside the limits detours keep, by the characteristic length
MOST_RESTORATIONS = 8
MOST_BENDS = 8


def is_joint_box(machine: Machine) -> bool:
    """Whether joint ranges are all that limits the machine.

    So it is with serial arms: every set of joints in range is one pose, connected with home.
    """
    limits = (_without_frames(limit) for limit in machine.constraints.limits)
    return all(isinstance(limit, JointRange) for limit in limits)


def is_by_joints(machine: Machine) -> bool:
    """Whether every set of joints in range is a pose, so that poses are best searched by joints.

    So it is with serial arms, also where their task space is limited.
    """
    limits = [_without_frames(limit) for limit in machine.constraints.limits]
    return not any(limit.group for limit in limits if isinstance(limit, Grouped))


def _without_frames(part: object) -> object:
    """The machine's own limit, behind one in other frames."""
    return getattr(part, 'inner', part)


def admits(machine: Machine, poses: Pose, near: Array | None = None) -> Mask:
    """Which of the poses (N,) close and keep every limit.

    On home's branch, or with `near` each on the branch of the pose before, the first near it.
    """
    kinematics = machine.kinematics
    if near is None:
        joints = kinematics.inverse_or_nan(poses)
    else:
        joints = kinematics.inverse_along(poses, near)
    return keeps_limits(machine, poses, joints)


def keeps_limits(machine: Machine, poses: Pose, joints: Array) -> Mask:
    """Which of the poses (N,) with their joints (N, n), NaN where they do not close, are kept."""
    inside = machine.constraints.admits(poses, joints)
    return inside if np.isfinite(joints.sum()) else inside & np.isfinite(joints).all(axis=-1)


def line_between(machine: Machine, start: Pose, end: Pose) -> Pose:
    """Poses from start to end, both with it, at most 1/70 of the characteristic length apart."""
    spacing = machine.kinematics.characteristic_length / CHECKS_PER_LENGTH
    count = int(np.ceil(float(distance(machine, start, end)) / spacing)) + 1
    return start.moved(np.linspace(0.0, 1.0, max(count, 2))[:, None] * start.twist_to(end))


def is_free(machine: Machine, start: Pose, end: Pose) -> bool:
    """Whether the line from start to end keeps all limits."""
    return bool(admits(machine, line_between(machine, start, end)).all())


def is_connected(machine: Machine, pose: Pose) -> bool:
    """Whether a free path leads from home to an admitted pose: straight, or a detour about limits.

    True is certain (to 1/70 of the characteristic length); False means that none was found.
    """
    if is_joint_box(machine):
        return True
    if not admits(machine, pose[None])[0]:
        return False
    home = machine.kinematics.home
    if are_linked(machine, home, pose) or _is_joint_line_free(machine, pose):
        return True
    last = home.moved(free_share_from_home(machine, pose) * home.twist_to(pose))
    return are_linked(machine, last, pose)


def _is_joint_line_free(machine: Machine, pose: Pose) -> bool:
    """Whether joints that move in proportion from home to a pose keep all limits.

    Asked of machines alone whose joints move each on its own: arms.
    """
    if not is_by_joints(machine):
        return False
    kinematics = machine.kinematics
    ends = kinematics.inverse(kinematics.home), kinematics.inverse(pose)
    count = int(np.abs(ends[1] - ends[0]).max() * CHECKS_PER_LENGTH) + 2
    joints = np.linspace(*ends, count)
    poses = kinematics.forward_along(joints, kinematics.home)
    return bool(machine.constraints.admits(poses, joints).all())


def are_linked(machine: Machine, start: Pose, end: Pose, bends: int = MOST_BENDS) -> bool:
    """Whether a path is free: straight, or a detour through middles that are moved inside."""
    if is_free(machine, start, end):
        return True
    middle = put_inside(machine, start.moved(0.5 * start.twist_to(end))) if bends else None
    return (
        middle is not None
        and are_linked(machine, start, middle, bends - 1)
        and are_linked(machine, middle, end, bends - 1)
    )


def put_inside(machine: Machine, pose: Pose) -> Pose | None:
    """A pose a little inside all limits, by Newton's method from one that breaks some, or None."""
    clearance = INSIDE * machine.kinematics.characteristic_length
    for _ in range(MOST_RESTORATIONS):
        found = slopes(machine, pose)
        margins = found.readings.margins
        rows = (found.steepness > 0.0) & np.isfinite(margins)
        steepness = found.steepness[rows]
        slack = margins[rows] / steepness - clearance
        step, weights = nearest_point(
            np.zeros(6), found.gradients[rows] / steepness[:, None], slack
        )
        if np.isnan(weights).any():
            return None
        if not step.any():
            return pose
        pose = displaced(machine, pose, step)
    return pose if admits(machine, pose[None])[0] else None


def free_share_from_home(machine: Machine, pose: Pose) -> float:
    """The part of the line from home to `pose` before the first limit, 1 for all of it."""
    home = machine.kinematics.home
    path = line_between(machine, home, pose)
    inside = admits(machine, path)
    if inside.all():
        return 1.0
    count = len(inside) - 1
    first = int(np.argmin(inside))
    return last_free(
        machine, home, offset(machine, home, pose), (first - 1) / count, first / count
    )


def last_free(
    machine: Machine,
    start: Pose,
    path: Array,
    free: float,
    beyond: float,
    near: Array | None = None,
) -> float:
    """Between an admitted part of `path` (6,) and one that is not: the last admitted one."""
    while beyond - free > 1e-12 * max(1.0, abs(beyond)):
        shares = np.linspace(free, beyond, 34)
        inside = admits(machine, displaced(machine, start, shares[1:-1, None] * path), near)
        first = len(inside) if inside.all() else int(np.argmin(inside))
        free, beyond = float(shares[first]), float(shares[first + 1])
    return max(free, 0.0)
