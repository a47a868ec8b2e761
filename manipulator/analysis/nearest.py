"""The reachable pose nearest to one that is out of reach: docs/workspace.md, section 2.

Where joint ranges are the only limits, the search is over joints, else over poses.
"""

from dataclasses import dataclass, replace

import numpy as np

from manipulator.analysis.free_paths import (
    admits,
    are_linked,
    free_share_from_home,
    is_by_joints,
    is_connected,
    is_joint_box,
)
from manipulator.analysis.readings import displaced, distance, offset, scale
from manipulator.arrays import Array
from manipulator.limits.limit import Search
from manipulator.machine import Machine
from manipulator.pose import Pose

SETTLED, DIFFERENCE = 1e-12, 1e-7
JOINT_CLEARANCE = 1e-9  # rad or m inside the ranges, so that the answer's inverse is in range, too
RANDOM_STARTS, FEWER_STARTS, MOST_ITERATIONS = 12, 3, 200


def nearest_by_joints(machine: Machine, target: Pose) -> Pose:
    """The pose nearest to `target` in the metric of `readings.distance`, over all joints in range.

    Bounded least squares (trust region reflective: Branch, Coleman, Li 1999) from home's joints
    and a fixed set of others; the best local minimum. Every such pose is connected to home through
    the joints' ranges.
    """
    kinematics, is_box = machine.kinematics, is_joint_box(machine)
    low, high = joint_box(machine)
    generator = np.random.default_rng(6)
    bounds = np.clip(low, -2 * np.pi, None), np.clip(high, None, 2 * np.pi)
    starts = [kinematics.inverse(kinematics.home), *generator.uniform(*bounds, (RANDOM_STARTS, 6))]
    best, least = kinematics.home, float(distance(machine, kinematics.home, target))
    descended = _descended_by_joints if is_box else _descended_within
    for start in starts if is_box else starts[: 1 + FEWER_STARTS]:
        pose = descended(machine, target, start, low, high)
        metres = float(distance(machine, pose, target))
        if metres < least and (is_box or is_connected(machine, pose)):
            best, least = pose, metres
        if least < SETTLED:
            break
    return best


def joint_box(machine: Machine) -> tuple[Array, Array]:
    """The joints' ranges (n,) each, a hair within."""
    low, high = machine.joint_ranges
    return low + JOINT_CLEARANCE, high - JOINT_CLEARANCE


def _descended_within(
    machine: Machine, target: Pose, start: Array, low: Array, high: Array
) -> Pose:
    """As `_descended_by_joints`, within all limits: sequential quadratic programming of scipy."""
    from scipy.optimize import minimize  # noqa: PLC0415 (50 MB: only needed here)

    kinematics, limits = machine.kinematics, machine.constraints
    ends = np.concatenate([limits.low, -limits.high])
    is_end = np.isfinite(ends)
    clearance = CLEARANCE * kinematics.characteristic_length

    def pose_of(joints: Array) -> Pose:
        return kinematics.forward(joints).pose

    def margins(joints: Array) -> Array:
        poses = kinematics.forward_along(joints, kinematics.home)
        values = limits.values(poses, joints)
        inside: Array = np.concatenate([values, -values], axis=-1)[..., is_end] - ends[is_end]
        return inside - clearance

    def slopes(joints: Array) -> Array:
        rows = margins(joints + DIFFERENCE * np.eye(1 + len(joints), len(joints), -1))
        return np.asarray((rows[1:] - rows[0]).T / DIFFERENCE)

    def squared(joints: Array) -> tuple[float, Array]:
        pose = pose_of(joints)
        missed, weights = offset(machine, pose, target), scale(machine)[:, None]
        return 0.5 * float(missed @ missed), -missed @ (
            weights * kinematics.jacobian(pose, joints)
        )

    found = minimize(
        squared, np.clip(start, low, high), jac=True, method='SLSQP',
        bounds=np.stack([low, high], axis=1),
        constraints={'type': 'ineq', 'fun': margins, 'jac': slopes},
        options={'ftol': SETTLED, 'maxiter': MOST_ITERATIONS},
    )  # fmt: skip
    return pose_of(np.clip(found.x, low, high))


def _descended_by_joints(
    machine: Machine, target: Pose, start: Array, low: Array, high: Array
) -> Pose:
    """A local minimum of the distance over joints (n,) between `low` and `high`."""
    from scipy.optimize import least_squares  # noqa: PLC0415 (50 MB: only needed here)

    kinematics, weights = machine.kinematics, scale(machine)[:, None]

    def pose_of(joints: Array) -> Pose:
        return kinematics.forward(joints).pose

    def slopes(joints: Array) -> Array:
        # What they miss, the Jacobian of the logarithm, leaves a rotation vector as it is: the
        # slope of the squared offset is exact.
        return -weights * kinematics.jacobian(pose_of(joints), joints)

    found = least_squares(
        lambda joints: offset(machine, pose_of(joints), target), np.clip(start, low, high), slopes,
        bounds=(low, high), ftol=SETTLED, xtol=SETTLED, gtol=SETTLED,
    )  # fmt: skip
    return pose_of(found.x)


MOST_STEPS = 60
CLEARANCE = 1e-6  # how far inside each limit an answer stays, by the characteristic length
WIDE = 30.0  # times that at first, since next to where a leg just closes slopes have no end
KICKS, KICK_POSES, KICK_RADII, KICK_GAIN = 12, 1500, (3e-2, 1e-2, 1e-3, 1e-4, 1e-5), 1e-5


@dataclass(frozen=True, eq=False)
class Nearest:
    """A reachable pose, and how far it is from the target, in metres (see `readings.distance`)."""

    pose: Pose
    distance: float


def nearest_reachable(machine: Machine, target: Pose) -> Nearest:
    """The pose nearest to `target` (itself, when it is reachable) that keeps all limits.

    It is admitted and connected to home: both are checked. It is a local minimum of the distance
    that a random search about it could not better, the best of three that are found from the ends
    of lines: from home towards the target, its position alone, its orientation alone.
    """
    if is_by_joints(machine):
        pose = nearest_by_joints(machine, target)
        return Nearest(pose, float(distance(machine, pose, target)))
    starts = _starts(machine, target)
    near = [_descended(machine, target, start) for start in starts]
    found = [(float(distance(machine, pose, target)), k) for k, pose in enumerate(near)]
    for _, k in sorted(found):
        end = _settled(machine, target, near[k])
        if is_connected(machine, end) or are_linked(machine, starts[k], end):
            return Nearest(end, float(distance(machine, end, target)))
    return Nearest(starts[0], float(distance(machine, starts[0], target)))


def _settled(machine: Machine, target: Pose, start: Pose) -> Pose:
    """A local minimum, left again as long as a random pose near it is nearer to the target."""
    generator = np.random.default_rng(8)
    length = machine.kinematics.characteristic_length
    pose = start
    for _ in range(KICKS):
        radii = length * generator.choice(KICK_RADII, (KICK_POSES, 1))
        trials = displaced(machine, pose, radii * generator.standard_normal((KICK_POSES, 6)))
        distances = distance(machine, trials, target)
        nearer = distances < float(distance(machine, pose, target)) - KICK_GAIN * length
        nearer[nearer] = admits(machine, trials[nearer])
        if not nearer.any():
            break
        best = int(np.argmin(np.where(nearer, distances, np.inf)))
        pose = _descended(machine, target, trials[best])
    return pose


def _descended(machine: Machine, target: Pose, start: Pose) -> Pose:
    """An admitted pose at a local minimum of the distance, from the admitted `start`."""
    clearance = CLEARANCE * machine.kinematics.characteristic_length
    wide = Search(target, WIDE * clearance, MOST_STEPS)
    pose = machine.constraints.descended(wide, start)
    return machine.constraints.descended(replace(wide, clearance=clearance), pose)


def _starts(machine: Machine, target: Pose) -> list[Pose]:
    """Ends of free paths from home, the straight one first; `target` alone when that is free."""
    home = machine.kinematics.home
    twist: Array = home.twist_to(target)
    straight = free_share_from_home(machine, target)
    if straight == 1.0:
        return [target]
    starts = [home.moved(straight * twist)]
    for part in (np.repeat([1.0, 0.0], 3), np.repeat([0.0, 1.0], 3)):
        end = home.moved(part * twist)
        starts.append(home.moved(free_share_from_home(machine, end) * part * twist))
    return starts
