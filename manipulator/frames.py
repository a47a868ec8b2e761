"""The user's frames: a work frame on the base, a pivot (tool point) on the platform."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from manipulator.config import PLACE_MM, TURN_DEG, quantity
from manipulator.errors import InvalidInput
from manipulator.pose import Pose

ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class FramesConfig:
    """The `frames` section of a machine file: where the work frame and the pivot are."""

    work_xyz_mm: tuple[float, float, float] = quantity(
        *PLACE_MM, 'origin of the work frame, base frame', default=ORIGIN
    )
    work_rpy_deg: tuple[float, float, float] = quantity(
        *TURN_DEG, 'its roll, pitch and yaw', default=ORIGIN
    )
    pivot_xyz_mm: tuple[float, float, float] = quantity(
        *PLACE_MM, 'the tool point, platform frame', default=ORIGIN
    )


@dataclass(frozen=True, eq=False)
class Frames:
    """T_base_work, and T_platform_pivot, which has the platform's axes.

    are_plain: work is base and the pivot is the platform's origin.
    """

    T_base_work: Pose = field(default_factory=Pose.identity)
    T_platform_pivot: Pose = field(default_factory=Pose.identity)
    are_plain: bool = field(init=False)

    def __post_init__(self) -> None:
        """Finds once whether there is anything to convert."""
        both = (self.T_base_work, self.T_platform_pivot)
        offsets = [Pose.identity().twist_to(pose) for pose in both]
        object.__setattr__(self, 'are_plain', not np.any(offsets))

    @classmethod
    def from_config(cls, config: FramesConfig) -> 'Frames':
        """In metres and radians."""
        work = Pose.from_xyz_rpy(
            np.array(config.work_xyz_mm) * 1e-3, np.radians(config.work_rpy_deg)
        )
        return cls(work).with_pivot([1e-3 * c for c in config.pivot_xyz_mm])

    def with_pivot(self, point: Sequence[float]) -> 'Frames':
        """Another pivot, platform frame, metres; InvalidInput where it is not finite."""
        position = np.array(point, dtype=np.float64)
        if not np.isfinite(position).all():
            raise InvalidInput(f'pivot {position.tolist()} is not finite')
        return replace(self, T_platform_pivot=Pose(position, np.eye(3)))

    def platform(self, T_work_pivot: Pose) -> Pose:
        """T_base_platform when the pivot is there."""
        if self.are_plain:
            return T_work_pivot
        return self.T_base_work @ T_work_pivot @ self.T_platform_pivot.inverse()

    def pivot(self, T_base_platform: Pose) -> Pose:
        """T_work_pivot when the platform is there."""
        if self.are_plain:
            return T_base_platform
        return self.T_base_work.inverse() @ T_base_platform @ self.T_platform_pivot
