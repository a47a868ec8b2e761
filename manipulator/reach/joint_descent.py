"""The nearest pose of a machine whose joints may take every value in their ranges."""

import numpy as np

from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.reach.metric import distance, offset, scale

MOST_STEPS = 200
DAMPINGS = (1e-9, 1e-6, 1e-4, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0)
SETTLED = 1e-12
CLEARANCE = 1e-9  # rad or m inside the ranges, so that the answer's inverse is in range, too
RANDOM_STARTS = 12


def nearest_by_joints(machine: Machine, target: Pose) -> Pose:
    """The pose nearest to `target` in the metric of `metric.distance`, over all joints in range.

    Projected Levenberg-Marquardt from home's joints and a fixed set of others; the best local
    minimum. Every such pose is connected to home through the joints' ranges.
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
    """A local minimum of the distance; several dampings are tried at each step."""
    kinematics = machine.kinematics
    joints = start
    pose = kinematics.forward(joints).pose
    metres = float(distance(machine, pose, target))
    for _ in range(MOST_STEPS):
        goal = offset(machine, pose, target)
        rows = scale(machine)[:, None] * kinematics.jacobian(pose, joints)
        pull = rows.T @ goal
        free = ~((joints <= low) & (pull < 0.0) | (joints >= high) & (pull > 0.0))
        trials = [joints + _damped(rows, goal, free, damping) for damping in DAMPINGS]
        clipped = [np.clip(trial, low, high) for trial in trials]
        poses = [kinematics.forward(trial).pose for trial in clipped]
        reached = [float(distance(machine, p, target)) for p in poses]
        best = int(np.argmin(reached))
        if not reached[best] < metres - SETTLED:
            break
        joints, pose, metres = clipped[best], poses[best], reached[best]
    return pose


def _damped(rows: Array, goal: Array, free: Mask, damping: float) -> Array:
    """The Levenberg-Marquardt step (n,) of the free joints; damping is relative."""
    step = np.zeros(rows.shape[1])
    chosen = rows[:, free]
    square = chosen.T @ chosen
    square += damping * max(float(np.trace(square)), SETTLED) * np.eye(len(square))
    step[free] = np.linalg.solve(square, chosen.T @ goal)
    return step
