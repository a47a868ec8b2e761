"""All limits of a platform at once, as the kernel computes and judges them: kernel/limits.h."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS
from manipulator import _kernel
from manipulator.arrays import Array, Mask, frozen, stretched
from manipulator.limits.limit import Bounds, BrakingPaths, Search
from manipulator.pose import Pose

SHORTFALL, SURPLUS, JOINT, TILT, SWING, LEANING = (slice(6 * k, 6 * k + 6) for k in range(6))
OF_POSE, HEIGHT, SIGMA = slice(36, 41), slice(38, 39), slice(41, 42)
VALUES, RANGES = 42, 46
"""Where values stand in `limited`, and the numbers in `limit_ranges`: kernel/limits.h."""

PATH = 20
PLAIN_FRAME = frozen(np.concatenate([np.zeros(3), np.eye(3).ravel(), np.zeros(3)]))
"""Numbers in `braking_path`, and the `jog_frame` that changes nothing: kernel/braking.h."""


@dataclass(frozen=True, eq=False)
class PlatformLimits:
    """The `LimitGroup` of a platform; parameters are `platform` of kernel/platform.h."""

    parameters: Array

    @property
    def of_pose(self) -> slice:
        """See `LimitGroup`."""
        return OF_POSE

    def limited_values(self, pose: Pose, joints: Array) -> Array:
        """See `LimitGroup`: all limited values (..., 42), in the order of kernel/limits.h."""
        position, rotation, given = _together(pose, joints)
        values = np.empty((*position.shape[:-1], VALUES))
        _kernel.limited_values(self.parameters, position, rotation, given, values)
        return values

    def ranges(self, bounds: Sequence[Bounds]) -> Array:
        """See `LimitGroup`."""
        ranges = np.empty(RANGES)
        _kernel.limit_ranges(self.parameters, *_lowest_and_highest(bounds), ranges)
        return ranges

    def descended(self, search: Search, bounds: Sequence[Bounds], start: Pose) -> Pose:
        """See `LimitGroup`."""
        target, position, rotation = search.target, np.empty(3), np.empty((3, 3))
        _kernel.descended(
            self.parameters, *_lowest_and_highest(bounds), search.pivot,
            np.array([search.clearance, search.most_steps]), target.position, target.rotation,
            start.position, start.rotation, position, rotation,
        )  # fmt: skip
        return Pose.unchecked(position, rotation)

    def first_free_path(self, ranges: Array, paths: BrakingPaths) -> tuple[int, Array]:
        """See `LimitGroup`."""
        pose, found = paths.pose, np.empty((len(paths.twists), PATH))
        frame = PLAIN_FRAME if paths.frame is None else paths.frame
        free = _kernel.first_free_path(
            self.parameters, ranges, frame, paths.bounds, pose.position, pose.rotation,
            paths.joints, paths.rates, paths.twists, found,
        )  # fmt: skip
        return free, found

    def keeps(self, ranges: Array, pose: Pose, joints: Array) -> Mask:
        """See `LimitGroup`."""
        position, rotation, given = _together(pose, joints)
        kept = np.empty(position.shape[:-1])
        _kernel.keeps_limits(self.parameters, ranges, position, rotation, given, kept)
        return np.asarray(kept != 0.0)


def _lowest_and_highest(bounds: Sequence[Bounds]) -> tuple[Array, Array]:
    """The strictest of all limited values (42,), ±∞ where there is none."""
    low, high = np.full(VALUES, -np.inf), np.full(VALUES, np.inf)
    for columns, least, most in bounds:
        low[columns] = np.maximum(low[columns], least)
        high[columns] = np.minimum(high[columns], most)
    return low, high


def _together(pose: Pose, joints: Array) -> tuple[Array, Array, Array]:
    """Position, rotation and joints with the same leading axes, as the kernel takes them."""
    position, rotation, shape = pose.position, pose.rotation, np.shape(joints)
    if shape[:-1] != position.shape[:-1]:
        leading = np.broadcast_shapes(shape[:-1], position.shape[:-1])
        position = stretched(position, (*leading, 3))
        rotation = stretched(rotation, (*leading, 3, 3))
        shape = (*leading, LEGS)
    return position, rotation, stretched(joints, (*shape[:-1], LEGS))
