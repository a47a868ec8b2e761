"""What identification needs: what was commanded, what was measured, and the machine's model.

A model has parameters, and computes the effect of each on a pose.
"""

from dataclasses import dataclass
from typing import Protocol

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


@dataclass(frozen=True)
class Parameter:
    """One number of a machine that may differ from its file.

    unit is 'm' or 'rad'; tolerance the standard deviation, in it, with which the machine was
    built: infinite where unknown.
    """

    name: str
    group: str
    unit: str
    tolerance: float


class Model(Protocol):
    """Values (p,) are differences from the machine file, in m or rad; joints (n, m) as commanded.

    Poses are the platform's or tool's, in the base frame.
    """

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """In the order of the values."""
        ...

    def predict(self, values: Array, joints: Array, near: Pose) -> Pose:
        """The poses (n,) of the machine, those nearest to `near` (n,).

        Raises NoSolution where it cannot stand anywhere.
        """
        ...

    def slopes(self, values: Array, joints: Array, poses: Pose) -> Array:
        """(n, 6, p): the twist at each pose by each parameter, with the joints held."""
        ...

    def rigid_motions(self, values: Array) -> dict[str, Array]:
        """Directions (p,) at `values` that move a whole side as one body, by what they are.

        Those that a frame of the measuring device can make up for are not to be seen.
        """
        ...
