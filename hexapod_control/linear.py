"""The linear Gough–Stewart platform as a `Kinematics`: six leg lengths, one pose.

The vectors from base to platform joints are computed for all legs of many poses at once:
docs/kinematics.md, (2.4).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from hexapod_control.forward import XYZXY
from hexapod_control.geometry import LEGS
from hexapod_control.linear_geometry import LinearGeometry
from hexapod_control.parallel_platform import ParallelPlatform
from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution
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


@dataclass(frozen=True, eq=False)
class LinearPlatform(ParallelPlatform):
    """Kinematics of a platform on six legs that change their length.

    A joint's position is the leg's length between its joint centres, in metres: L of Lapikov et
    al. 2014, and no machine's zero. Every pose has one inverse; whether a leg can be as long as
    that is the business of `Constraints`. Construction as of `ParallelPlatform`.
    """

    geometry: LinearGeometry
    gaps: LegGaps = field(init=False)
    columns: Array = field(init=False)

    def __post_init__(self) -> None:
        """Lays out the base points for the inverse and for the forward solver."""
        g = self.geometry
        axes = np.tile(np.eye(3)[:, None], (1, LEGS, 1))
        object.__setattr__(self, 'gaps', LegGaps(axes, g.base_points, g.platform_points))
        columns = frozen(g.base_points.T.take(XYZXY, axis=0))
        object.__setattr__(self, 'columns', columns)
        super().__post_init__()

    @property
    def joint_names(self) -> tuple[str, ...]:
        """leg_1 to leg_6."""
        return tuple(f'leg_{leg}' for leg in range(1, LEGS + 1))

    @property
    def joint_unit(self) -> str:
        """Metres."""
        return 'm'

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Leg lengths (..., 6), Lapikov et al. 2014, section 2.1; `near` changes nothing."""
        return self.inverse_or_nan(pose, near)

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`: no leg fails to close."""
        lengths = np.concatenate([self._lengths(part) for part in chunks(pose)])
        return lengths.reshape(*pose.position.shape[:-1], LEGS)

    def base_points(self, joints: Array) -> Array:
        """The base's joint centres (..., 6, 3), whatever the lengths."""
        missing = np.isnan(joints)[..., None]
        return np.where(missing, np.nan, self.geometry.base_points)

    def rod_lengths(self, joints: Array) -> Array:
        """The joints themselves; NoSolution where one is not above 0."""
        if not (joints > 0.0).all():
            leg = int(np.argmin(joints))
            raise NoSolution(f'leg {leg + 1}: length {joints[leg]:.4g} m is not above 0')
        return joints

    def joint_gains(self, pose: Pose, joints: Array) -> Array:
        """1 for every leg."""
        return np.ones(np.shape(joints))

    def leverage(self, pose: Pose, joints: Array) -> Array:
        """1 for every leg: linear legs have no inverse singularity."""
        return np.ones(np.shape(joints))

    def _lengths(self, pose: Pose) -> Array:
        """(N, 6) of N poses."""
        squares = self.gaps(pose) ** 2
        squares[:LEGS] += squares[LEGS : 2 * LEGS]
        squares[:LEGS] += squares[2 * LEGS :]
        lengths: Array = np.sqrt(squares[:LEGS].T)
        return lengths

    def _base_columns(self, joints: Array) -> Array:
        return self.columns
