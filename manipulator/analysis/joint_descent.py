"""The nearest pose of a machine whose joints may take every value in their ranges."""

import numpy as np

from manipulator.analysis.readings import distance, offset, scale
from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

SETTLED = 1e-12
CLEARANCE = 1e-9  # rad or m inside the ranges, so that the answer's inverse is in range, too
RANDOM_STARTS = 12


def nearest_by_joints(machine: Machine, target: Pose) -> Pose:
    """The pose nearest to `target` in the metric of `metric.distance`, over all joints in range.

    Bounded least squares (trust region reflective: Branch, Coleman, Li 1999) from home's joints
    and a fixed set of others; the best local minimum. Every such pose is connected to home through
    the joints' ranges.
    """
    kinematics = machine.kinematics
    low, high = joint_box(machine)
    generator = np.random.default_rng(6)
    bounds = np.clip(low, -2 * np.pi, None), np.clip(high, None, 2 * np.pi)
    starts = [kinematics.inverse(kinematics.home), *generator.uniform(*bounds, (RANDOM_STARTS, 6))]
    best, least = kinematics.home, float(distance(machine, kinematics.home, target))
    for start in starts:
        pose = _descended(machine, target, start, low, high)
        metres = float(distance(machine, pose, target))
        if metres < least:
            best, least = pose, metres
        if least < SETTLED:
            break
    return best


def joint_box(machine: Machine) -> tuple[Array, Array]:
    """The strictest bounds (n,) of a machine with joint ranges alone, a hair within."""
    limits = machine.constraints.limits
    return (
        np.max([limit.low for limit in limits], axis=0) + CLEARANCE,
        np.min([limit.high for limit in limits], axis=0) - CLEARANCE,
    )


def _descended(machine: Machine, target: Pose, start: Array, low: Array, high: Array) -> Pose:
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
