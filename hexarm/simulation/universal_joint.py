"""A universal joint as two hinges: the angles that turn a rod from its home to a direction."""

from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen


@dataclass(frozen=True, eq=False)
class UniversalJoint:
    """Hinge 1 about the unit vector first_axis, then hinge 2 about second_axis, which it carries.

    home is the rod's unit direction at zero angles; second_axis is square to it and to hinge 1.
    """

    first_axis: Array
    home: Array
    second_axis: Array = field(init=False)

    def __post_init__(self) -> None:
        """Places the second hinge."""
        second = np.cross(self.first_axis, self.home)
        object.__setattr__(self, 'second_axis', frozen(second / np.linalg.norm(second)))

    @classmethod
    def across(cls, home: Array) -> 'UniversalJoint':
        """With both hinges square to the rod at home."""
        least = np.eye(3)[np.argmin(np.abs(home))]
        first = np.cross(home, least)
        return cls(frozen(first / np.linalg.norm(first)), frozen(home))

    def angles(self, direction: Array) -> Array:
        """Both angles (..., 2) in radians for unit directions (..., 3), hinge 1's carrier's axes.

        Turning about the second axis lowers the part along the first; turning about the first
        leaves that part.
        """
        rise = np.arcsin(np.clip(self.home @ self.first_axis, -1.0, 1.0))
        now = np.arcsin(np.clip(direction @ self.first_axis, -1.0, 1.0))
        out = np.cross(self.second_axis, self.first_axis)
        azimuth = np.arctan2(direction @ self.second_axis, direction @ out)
        return np.stack([azimuth, rise - now], axis=-1)
