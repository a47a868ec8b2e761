"""What identification needs to know of a machine: its parameters and what each does to a pose."""

from dataclasses import dataclass
from typing import Protocol

from manipulator.arrays import Array
from manipulator.pose import Pose


@dataclass(frozen=True)
class Parameter:
    """One number of a machine that may be otherwise than its file says.

    unit is 'm' or 'rad'; tolerance the standard deviation, in it, with which the machine was
    built: infinite where nobody can say.
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
        """The poses (n,) at which the machine stands, those nearest to `near` (n,).

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
