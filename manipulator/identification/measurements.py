"""What was commanded, what was measured, and how well."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.pose import Pose


@dataclass(frozen=True)
class Noise:
    """Standard deviations of the measuring device, per axis: m and rad."""

    position: float
    rotation: float

    def __post_init__(self) -> None:
        for name, value in (('position', self.position), ('rotation', self.rotation)):
            if not 0.0 < value < 1.0:
                raise InvalidInput(f'{name} noise {value:g} outside (0, 1)')

    @property
    def weights(self) -> Array:
        """(6,): what makes errors (m, rad) multiples of the noise."""
        return np.repeat([1.0 / self.position, 1.0 / self.rotation], 3)


@dataclass(frozen=True, eq=False)
class Measurements:
    """Joints (n, m) as commanded, in rad or m, and poses (n,) of the marker in the device's frame.

    Raises InvalidInput where there are not as many of both.
    """

    joints: Array
    poses: Pose

    def __post_init__(self) -> None:
        object.__setattr__(self, 'joints', frozen(self.joints))
        if self.poses.position.shape != (len(self.joints), 3):
            raise InvalidInput(
                f'{len(self.joints)} sets of joints for poses {self.poses.position.shape}'
            )

    @property
    def count(self) -> int:
        """How many poses were measured."""
        return len(self.joints)
