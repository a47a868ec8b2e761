"""How near a machine is to its limits: the share of room left, and the colour that shows it."""

import numpy as np

from manipulator.arrays import Array
from manipulator.machine import Machine
from manipulator.pose import Pose

GOOD, NARROW, NONE_LEFT = (18, 150, 84), (224, 130, 8), (206, 32, 22)
COMFORTABLE = 0.35
"""The share of a limit's room from which everything is well."""


def shares(machine: Machine, pose: Pose, joints: Array) -> dict[str, float]:
    """By owner ('leg 3', 'joint 2', '' for the whole machine), the least share of room left.

    1 in the middle of a range, 0 at its end, negative beyond. A range with one end is taken to
    be as wide as home is far from that end.
    """
    home = machine.kinematics.home
    at_home = machine.kinematics.inverse(home)
    found: dict[str, float] = {}
    for limit in machine.constraints.limits:
        room = _room(limit.values(home, at_home), limit.low, limit.high)
        values = limit.values(pose, joints)
        left = np.fmin(values - limit.low, limit.high - values) / room
        for owner, share in zip(limit.owners, left, strict=True):
            if np.isfinite(share):
                found[owner] = min(found.get(owner, 1.0), float(share))
    return found


def colour(share: float) -> tuple[int, int, int]:
    """Green with room to spare, amber where it gets narrow, red at the limit."""
    at = float(np.clip(share / COMFORTABLE, 0.0, 1.0))
    lower, upper, part = (NONE_LEFT, NARROW, 2 * at) if at < 0.5 else (NARROW, GOOD, 2 * at - 1)
    red, green, blue = (round(a + part * (b - a)) for a, b in zip(lower, upper, strict=True))
    return red, green, blue


def _room(home: Array, low: Array, high: Array) -> Array:
    """Half of each range, or home's distance from the one end that there is."""
    half = (high - low) / 2
    nearer = np.fmin(home - low, high - home)
    return np.where(np.isfinite(half), half, np.maximum(nearer, 1e-9))
