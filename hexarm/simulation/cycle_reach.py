"""The cycle of Prokopovich 2019, fig. 12, all six axes in phase, and what of it is in reach."""

import itertools
from dataclasses import replace

import numpy as np

from manipulator.arrays import Array, Mask
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.trajectory.cycle import Cycle

PAPER_AMPLITUDE = (6e-3, 6e-3, 3e-3, 0.1, 0.1, 0.08)
"""x, y, z in m; about x (ψ), y (θ), z (φ) in rad."""
CHECKED = 400
QUARTER = 0.25


def in_phase(home: Pose, amplitude: Array, frequency: float) -> Cycle:
    """All six axes as the same sine of `frequency` hertz."""
    return Cycle(home, np.asarray(amplitude), np.full(6, frequency), np.zeros(6))


def poses_of(cycle: Cycle) -> Pose:
    """A period of the cycle, evenly in time."""
    return cycle.at(np.linspace(0.0, cycle.checked_duration, CHECKED)).pose


def inside(machine: Machine, poses: Pose) -> Mask:
    """Which of the poses (N) close and keep every limit."""
    joints = machine.kinematics.inverse_or_nan(poses)
    found = np.asarray(np.isfinite(joints).all(axis=-1), dtype=np.bool_)
    found[found] = machine.constraints.admits(poses[found], joints[found])
    return found


def share_in_reach(machine: Machine, cycle: Cycle) -> float:
    """The largest part of a cycle's amplitudes that stays in reach, to a thousandth; at most 1."""

    def holds(part: float) -> bool:
        smaller = replace(cycle, amplitude=part * cycle.amplitude)
        return bool(inside(machine, poses_of(smaller)).all())

    if holds(1.0):
        return 1.0
    low, high = 0.0, 1.0
    while high - low > 1e-3:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def corners_out(machine: Machine, amplitude: Array) -> int:
    """Of the 64 poses with each amplitude at + or −, how many the machine cannot take.

    What other phases between the axes may come to.
    """
    signs = itertools.product((-1.0, 1.0), repeat=6)
    cycles = [in_phase(machine.kinematics.home, s * amplitude, 1.0) for s in np.array(list(signs))]
    corners = [cycle.at(QUARTER).pose for cycle in cycles]
    position, rotation = ([getattr(c, n) for c in corners] for n in ('position', 'rotation'))
    return int(np.sum(~inside(machine, Pose(np.array(position), np.array(rotation)))))
