"""Gaps from base to platform joints, all legs of many poses at once: docs/kinematics.md, (2.4)."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

CHUNK = 2048  # stays in cache, and below where BLAS sets its threads to work


@dataclass(frozen=True, eq=False)
class LegGaps:
    """The gap v = a' − c of each leg, in the coordinates of its own three axes.

    axes (3, 6, 3) are unit vectors, base_points c (6, 3) in the base frame, platform_points a (6,
    3) in the platform frame. v is linear in the twelve numbers of a pose, so that one matrix
    product serves all legs of all poses: legs first, to be quick over N.
    """

    axes: Array
    base_points: Array
    platform_points: Array
    matrix: Array = field(init=False)
    offset: Array = field(init=False)

    def __post_init__(self) -> None:
        """Lays out v·e = Σ eⱼ Rⱼₖ aₖ + e·p − e·c as an (18, 12) matrix and an offset."""
        axes = self.axes
        turned = axes[..., :, None] * self.platform_points[:, None, :]
        matrix = np.concatenate([turned.reshape(*axes.shape[:2], 9), axes], axis=-1)
        offset = -(axes * self.base_points).sum(axis=-1)
        object.__setattr__(self, 'matrix', frozen(matrix.reshape(-1, 12)))
        object.__setattr__(self, 'offset', frozen(offset.reshape(-1, 1)))

    def __call__(self, pose: Pose) -> Array:
        """The gaps (18, N) of poses (...): all legs along axis 1, then 2, then 3."""
        rotation = pose.rotation.reshape(-1, 9)
        numbers = np.concatenate((rotation, pose.position.reshape(-1, 3)), axis=1)
        gap: Array = self.matrix.dot(numbers.T)
        gap += self.offset
        return gap


def chunks(pose: Pose) -> Iterator[Pose]:
    """The poses (...) in one row, cut into parts that are quick to work on; at least one."""
    position, rotation = pose.position.reshape(-1, 3), pose.rotation.reshape(-1, 3, 3)
    for start in range(0, max(len(position), 1), CHUNK):
        part = slice(start, start + CHUNK)
        yield Pose.unchecked(position[part], rotation[part])
