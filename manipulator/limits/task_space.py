"""Limits in task space: where platform or tool may be, how it may be turned, how fast it moves.

The section `task_space` of a machine file, docs/motion.md, section 1.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from manipulator import rotation as so3
from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, RATE, TURN_DEG, quantity
from manipulator.errors import ConfigError
from manipulator.limits.limit import Limit, LimitGroup
from manipulator.pose import Pose

QUANTITIES = ('position x', 'position y', 'position z', 'tilt', 'turn')
UNITS = ('m', 'm', 'm', 'rad', 'rad')
Range = tuple[float, float]
PerAxis = tuple[float, float, float]


@dataclass(frozen=True)
class TaskSpaceConfig:
    """The `task_space` section of a machine file: all of it is optional.

    Positions are those of the platform or tool in the base frame. Tilt is the angle of its z axis
    to where that points at home, turn its rotation about its z axis since home; with
    upright_rpy_deg both count from this orientation instead. Speeds are along and about the axes
    in which motion is commanded.
    """

    x_mm: Range | None = quantity(*PLACE_MM, "of the platform's origin or the tool", default=None)
    y_mm: Range | None = quantity(*PLACE_MM, 'likewise', default=None)
    z_mm: Range | None = quantity(*PLACE_MM, 'likewise', default=None)
    tilt_deg: float | None = quantity(
        1e-3, 180, 'most angle of its z axis to where that points at home', default=None
    )
    turn_deg: Range | None = quantity(
        -180, 180, 'rotation about its z axis since home', default=None
    )
    upright_rpy_deg: PerAxis | None = quantity(
        *TURN_DEG, "an arm's orientation from which tilt and turn count, not home's", default=None
    )
    speeds_mm_s: PerAxis | None = quantity(
        *RATE, 'most along the x, y and z axis of the work frame', default=None
    )
    turning_speeds_deg_s: PerAxis | None = quantity(*RATE, 'most about them', default=None)

    def __post_init__(self) -> None:
        """Raises ConfigError with every range that is empty."""
        ranges = {k: getattr(self, k) for k in ('x_mm', 'y_mm', 'z_mm', 'turn_deg')}
        problems = [
            f'{key}: [{ends[0]:g}, {ends[1]:g}] is no range'
            for key, ends in ranges.items()
            if ends is not None and not ends[0] < ends[1]
        ]
        if problems:
            raise ConfigError(problems)

    @property
    def speeds(self) -> Array:
        """The most along and about each axis (6,), in m/s and rad/s; ∞ where there is no limit."""
        free = (np.inf,) * 3
        return frozen(
            [
                *(1e-3 * np.array(self.speeds_mm_s or free)),
                *np.radians(self.turning_speeds_deg_s or free),
            ]
        )

    def limits(self, home: Pose, group: LimitGroup | None) -> tuple[Limit, ...]:
        """Those on poses, for a machine with that home; group: what computes all of its limits.

        Raises ConfigError for an upright that such a group does not know.
        """
        if group is not None and self.upright_rpy_deg is not None:
            raise ConfigError(['upright_rpy_deg: tilt and turn of a platform count from home'])
        given = self.upright_rpy_deg
        upright = home.rotation if given is None else so3.from_rpy(np.radians(given))
        first = 0 if group is None else group.of_pose.start
        return tuple(
            PoseLimit(k, low, high, upright, group, slice(first + k, first + k + 1))
            for k, low, high in self._ranges()
        )

    def _ranges(self) -> Iterator[tuple[int, float, float]]:
        """Which of QUANTITIES are limited, and to what, in SI units."""
        for k, ends in enumerate((self.x_mm, self.y_mm, self.z_mm)):
            if ends is not None:
                yield k, 1e-3 * ends[0], 1e-3 * ends[1]
        if self.tilt_deg is not None:
            yield 3, -np.inf, float(np.radians(self.tilt_deg))
        if self.turn_deg is not None:
            low, high = np.radians(self.turn_deg)
            yield 4, float(low), float(high)


@dataclass(frozen=True, eq=False)
class PoseLimit:
    """A `Limit` on one of QUANTITIES, between `least` and `most`.

    upright (3, 3): the orientation from which tilt and turn count. group and columns: see
    `Grouped`.
    """

    index: int
    least: float
    most: float
    upright: Array
    group: LimitGroup | None = None
    columns: slice = field(default_factory=lambda: slice(0))
    owners: tuple[str, ...] = ('',)
    low: Array = field(init=False)
    high: Array = field(init=False)

    def __post_init__(self) -> None:
        """Puts the bounds into the arrays that every limit has."""
        object.__setattr__(self, 'low', frozen([self.least]))
        object.__setattr__(self, 'high', frozen([self.most]))

    @property
    def quantity(self) -> str:
        """Which it is."""
        return QUANTITIES[self.index]

    @property
    def unit(self) -> str:
        """Metres or radians."""
        return UNITS[self.index]

    def values(self, pose: Pose, joints: Array) -> Array:
        """The value at each pose, (..., 1)."""
        return pose_values(pose, self.upright)[..., self.index : self.index + 1]


def pose_values(pose: Pose, upright: ArrayLike) -> Array:
    """The QUANTITIES (..., 5) of poses: position, tilt, and turn within half a turn of upright."""
    relative = np.swapaxes(np.asarray(upright), -1, -2) @ pose.rotation
    tilt = np.arccos(np.clip(relative[..., 2, 2], -1.0, 1.0))
    turn = np.arctan2(
        relative[..., 1, 0] - relative[..., 0, 1], relative[..., 0, 0] + relative[..., 1, 1]
    )
    return np.concatenate([pose.position, tilt[..., None], turn[..., None]], axis=-1)
