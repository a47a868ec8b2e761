"""What the inverses of a chain have in common, and which one fits a chain."""

from typing import Protocol

from arm_control.chain import Chain
from arm_control.closed_forms import ClosedForm, closed_form
from arm_control.joint_limits import JointLimits
from arm_control.numerical import AlmostClosed, Numerical, idealised
from manipulator.arrays import Array
from manipulator.pose import Pose


class InverseMethod(Protocol):
    """All joint angles of a pose, on every branch that the method knows."""

    @property
    def is_explicit(self) -> bool:
        """Whether it is a closed form."""
        ...

    @property
    def form(self) -> ClosedForm | None:
        """The closed form that the arm has, or almost."""
        ...

    def arm_numbers(self, length: float, low: Array, high: Array) -> Array:
        """The arm with its inverse and joint ranges, as `struct arm` (kernel/arm.h) has them."""
        ...

    def branches(self, pose: Pose, near: Array) -> Array:
        """Joints (..., k, 6), by any whole turns; NaN rows for branches that do not close.

        near (..., 6) gives the joints that the pose leaves free, as in an aligned wrist.
        """
        ...

    def refusal(self, pose: Pose) -> str:
        """Why one pose has no branch: what, how far, and how far would be reachable."""
        ...


def fitting_method(chain: Chain, limits: JointLimits, length: float) -> InverseMethod:
    """The closed form that the chain admits, or almost, else the numerical one (length in m)."""
    closed = closed_form(chain)
    if closed is not None:
        return closed
    numerical = Numerical(chain, length, limits.low, limits.high)
    for ideal in idealised(chain):
        closed = closed_form(ideal)
        if closed is not None:
            return AlmostClosed(closed, numerical)
    return numerical
