"""Poses along simple shapes, to make paths of."""

from math import acos, ceil

import numpy as np
from numpy.typing import ArrayLike

from manipulator import rotation as so3
from manipulator.errors import InvalidInput
from manipulator.pose import Pose

MOST_POSES = 2000


def line(start: Pose, goal: Pose) -> Pose:
    """The two ends of a straight way, (2,)."""
    return Pose(
        np.stack([start.position, goal.position]), np.stack([start.rotation, goal.rotation])
    )


def arc(
    start: Pose,
    centre: ArrayLike,
    axis: ArrayLike,
    angle: float,
    is_turning: bool = False,
    sagitta: float = 1e-5,
) -> Pose:
    """From `start` about the axis through `centre` (m) by `angle` (rad, any number of turns).

    The orientation stays, or turns along where is_turning. Poses (n,) lie so close that the
    chords between them are within `sagitta` (m) of the arc. Raises InvalidInput for an axis
    without direction and for arcs that need more than 2,000 poses.
    """
    direction, middle = (np.asarray(v, dtype=np.float64) for v in (axis, centre))
    length = float(np.linalg.norm(direction))
    if not (length > 0 and np.isfinite(direction).all() and np.isfinite([angle, *middle]).all()):
        raise InvalidInput(f'arc about {middle.tolist()}, axis {direction.tolist()}, {angle} rad')
    arm = start.position - middle
    radius = float(np.linalg.norm(np.cross(direction / length, arm)))
    step = 2 * acos(max(1.0 - sagitta / max(radius, sagitta), 0.0))
    count = max(ceil(abs(angle) / step), 2) + 1
    if count > MOST_POSES:
        raise InvalidInput(f'an arc of {count} poses, at most {MOST_POSES}: allow more sagitta')
    turns = so3.exp(np.linspace(0.0, angle, count)[:, None] * direction / length)
    rotation = turns @ start.rotation if is_turning else start.rotation
    return Pose(middle + turns @ arm, rotation)
