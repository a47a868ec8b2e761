"""The whole workspace: the poses that a machine reaches from home without leaving its limits.

docs/kinematics.md, section 7. Works for every machine whose joints follow from its pose.
"""

import numpy as np

from manipulator.analysis.free_paths import admits
from manipulator.analysis.travel import travel
from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose

CHECKS_PER_LENGTH = 70
CHECKS_PER_STEP = 12
BURN_IN = 80
THINNING = 8
WALKERS = 1000


def sample(machine: Machine, count: int, generator: np.random.Generator) -> Pose:
    """`count` poses spread evenly over the connected component of home.

    Walkers set out from home and take random twists, rotations made lengths by the machine's
    characteristic length. A step is at most 12/70 of that length and is taken only if the
    poses of its path, 1/70 apart, are all admitted: a walker can leave the component only through
    a gap narrower than that. A path and its reverse are equally likely, so the walk's
    limit is the even distribution. Poses of one walker are neighbours: take many poses.
    """
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    walkers = min(count, WALKERS)
    pose = Pose(np.tile(home.position, (walkers, 1)), np.tile(home.rotation, (walkers, 1, 1)))
    rounds = -(-count // walkers)
    found = []
    for tick in range(BURN_IN + (rounds - 1) * THINNING + 1):
        if tick >= BURN_IN and (tick - BURN_IN) % THINNING == 0:
            found.append(pose)
        pose = _walked(machine, pose, generator, length)
    return Pose(
        np.concatenate([p.position for p in found])[:count],
        np.concatenate([p.rotation for p in found])[:count],
    )


def axis_range(machine: Machine, axis: int) -> tuple[float, float]:
    """How far home moves along one axis alone: 0–2 are x, y, z in m, 3–5 about them in rad.

    The lowest and highest offset before the first limit.
    """
    home, twist = machine.kinematics.home, np.eye(6)[axis]
    return -travel(machine, home, -twist).seconds, travel(machine, home, twist).seconds


def _walked(machine: Machine, pose: Pose, generator: np.random.Generator, length: float) -> Pose:
    """Every walker after one step, or where it was when the step's path is not free."""
    walkers = pose.position.shape[0]
    twist = generator.standard_normal((walkers, 6))
    twist /= np.sqrt((twist * twist).sum(axis=1, keepdims=True))
    twist *= generator.uniform(0.0, CHECKS_PER_STEP / CHECKS_PER_LENGTH * length, (walkers, 1))
    twist[:, 3:] /= length
    end = pose.moved(twist)
    free = np.flatnonzero(admits(machine, end))
    free = free[_is_path_free(machine, pose[free], twist[free])]
    position, rotation = pose.position.copy(), pose.rotation.copy()
    position[free], rotation[free] = end.position[free], end.rotation[free]
    return Pose(position, rotation)


def _is_path_free(machine: Machine, pose: Pose, twist: Array) -> Mask:
    """Which of N paths (N, 6) are admitted everywhere between their begin and their end."""
    parts = np.arange(1, CHECKS_PER_STEP)[:, None] / CHECKS_PER_STEP
    path = pose[:, None].moved(parts * twist[:, None])
    poses = Pose.unchecked(path.position.reshape(-1, 3), path.rotation.reshape(-1, 3, 3))
    return np.asarray(admits(machine, poses).reshape(-1, len(parts)).all(axis=1))
