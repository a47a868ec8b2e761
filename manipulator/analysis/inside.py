"""What a machine is like at the poses that it reaches: conditioning, joint speed, sections."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from manipulator.analysis.free_paths import admits
from manipulator.analysis.readings import CHECKS_PER_LENGTH
from manipulator.analysis.travel import travel
from manipulator.arrays import Array, Mask
from manipulator.kinematics import POSE_NUMBERS, chosen_rates
from manipulator.machine import Machine
from manipulator.pose import Pose

AXES = ('x', 'y', 'z', 'roll', 'pitch', 'yaw')
BISECTIONS = 30
FARTHEST = 30  # characteristic lengths
RANK = 1e-9


@dataclass(frozen=True, eq=False)
class Conditions:
    """At poses (...): σmin, and the largest joint speed of a unit speed of translation.

    joint_speed is in rad/m or m/m, in the worst direction. NaN where a pose is not admitted.
    """

    admitted: Mask
    sigma_min: Array
    joint_speed: Array


def conditions(machine: Machine, poses: Pose) -> Conditions:
    """For N poses with all limits kept."""
    inside = admits(machine, poses)
    sigma, speed = np.full(len(inside), np.nan), np.full(len(inside), np.nan)
    if inside.any():
        chosen = poses[inside]
        joints = machine.kinematics.inverse_or_nan(chosen)
        sigma[inside] = machine.kinematics.sigma_min(chosen, joints)
        rates = joint_rates(machine, chosen)[..., :3]
        speed[inside] = np.linalg.norm(rates, axis=-1).max(axis=-1)
    return Conditions(inside, sigma, speed)


def joint_rates(machine: Machine, poses: Pose) -> Array:
    """(..., n, 6): the joint rates of a unit twist, at poses that are admitted.

    Of a machine with more joints than a pose has numbers: of the joints that its inverse chooses.
    """
    joints = machine.kinematics.inverse_or_nan(poses)
    if joints.shape[-1] > POSE_NUMBERS:
        units = np.eye(POSE_NUMBERS)
        columns = [chosen_rates(machine.kinematics, poses, joints, unit) for unit in units]
        return np.stack(columns, axis=-1)
    jacobian = machine.kinematics.jacobian(poses, joints)
    return np.asarray(np.linalg.pinv(jacobian, rcond=RANK), dtype=np.float64)


def ranges(
    machine: Machine, on_progress: Callable[[float], None] = lambda share: None
) -> dict[str, tuple[float, float]]:
    """How far home moves along and about each axis alone, metres and radians."""
    found = {}
    for axis, name in enumerate(AXES):
        unit = np.zeros(6)
        unit[axis] = 1.0
        low, high = (
            travel(machine, machine.kinematics.home, sign * unit).seconds for sign in (-1.0, 1.0)
        )
        found[name] = (-low, high)
        on_progress((axis + 1) / len(AXES))
    return found


def surface(machine: Machine, directions: Array) -> Array:
    """Where lines from home, unturned, end: positions (..., 3) for unit directions."""
    home, length = machine.kinematics.home, machine.kinematics.characteristic_length
    flat = directions.reshape(-1, 3)
    free, step = np.zeros(len(flat)), length / CHECKS_PER_LENGTH
    going = np.arange(len(flat))
    for tick in range(1, FARTHEST * CHECKS_PER_LENGTH):
        going = going[_admits_at(machine, home, flat[going] * (tick * step))]
        free[going] = tick * step
        if not going.size:
            break
    beyond = free + step
    for _ in range(BISECTIONS):
        middle = (free + beyond) / 2
        inside = _admits_at(machine, home, flat * middle[:, None])
        free, beyond = np.where(inside, middle, free), np.where(inside, beyond, middle)
    ends: Array = home.position + free[:, None] * flat
    return ends.reshape(directions.shape)


def _admits_at(machine: Machine, home: Pose, offsets: Array) -> Mask:
    turned = np.broadcast_to(home.rotation, (len(offsets), 3, 3))
    return admits(machine, Pose(home.position + offsets, turned))


@dataclass(frozen=True, eq=False)
class Section:
    """A plane through home, along two axes (0, 1, 2 for x, y, z), unturned.

    across and up (n,) are the coordinates in metres; the fields of conditions are (n, n), row by
    row of `up`.
    """

    axes: tuple[int, int]
    across: Array
    up: Array
    conditions: Conditions


def section(
    machine: Machine, axes: tuple[int, int], low: Array, high: Array, count: int
) -> Section:
    """On a grid of count × count between the corners low and high (3,) of a box."""
    home = machine.kinematics.home
    across, up = (np.linspace(low[axis], high[axis], count) for axis in axes)
    places = np.tile(home.position, (count, count, 1))
    places[..., axes[0]], places[..., axes[1]] = across[None, :], up[:, None]
    turned = np.broadcast_to(home.rotation, (count * count, 3, 3))
    found = conditions(machine, Pose(places.reshape(-1, 3), turned))
    grid = Conditions(
        found.admitted.reshape(count, count),
        found.sigma_min.reshape(count, count),
        found.joint_speed.reshape(count, count),
    )
    return Section(axes, across, up, grid)
