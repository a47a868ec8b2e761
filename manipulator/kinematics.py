"""The one interface of crank platforms, linear platforms and serial arms."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from manipulator.arrays import Array
from manipulator.links import Link, Stroke
from manipulator.pose import Pose


@dataclass(frozen=True)
class ForwardSolution:
    """A pose found from joint positions, and how far to trust it.

    residual is the largest closure error in metres, sigma_min the smallest singular value of the
    Jacobian with unit rod directions (or joint axes) and rotations scaled by the characteristic
    length: dimensionless, near 0 where the joints no longer fix the pose.
    """

    pose: Pose
    iterations: int
    residual: float
    sigma_min: float


class Kinematics(Protocol):
    """Stateless: the caller passes what to stay near. n joints, radians or metres.

    `inverse` and its relatives broadcast over the leading axes of the pose; `forward` takes one
    set of joints. The twist is that of the moving frame's origin, in base axes (see pose.py).
    """

    @property
    def joint_names(self) -> tuple[str, ...]:
        """One name a joint, in the order of every joint array."""
        ...

    @property
    def joint_unit(self) -> str:
        """'rad' or 'm'."""
        ...

    @property
    def home(self) -> Pose:
        """The pose from which a cold forward solution starts."""
        ...

    @property
    def characteristic_length(self) -> float:
        """Metres; makes rotations lengths in σmin and in distances between poses."""
        ...

    @property
    def is_explicit(self) -> bool:
        """Whether the inverse is a closed form, so that a pose costs the same everywhere."""
        ...

    @property
    def joins_branches(self) -> bool:
        """Whether it may be driven from branch to branch where they meet, as an arm."""
        ...

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """Joints (..., n) for the pose, on the branch nearest to `near` (default: home's branch).

        Raises Unreachable, naming the leg and by how much, where the mechanism does not close.
        Joint ranges and other limits are the business of `Constraints`.
        """
        ...

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """As `inverse`, with NaN for each joint that does not close: for arrays of poses."""
        ...

    def inverse_along(self, poses: Pose, near: Array) -> Array:
        """Joints (N, n) for a row of N poses on one branch, that which `near` (n,) is on.

        Continuous, also beyond the joint ranges: what jumps changes its branch there. NaN for each
        joint that does not close.
        """
        ...

    def forward(self, joints: Array, near: Pose | None = None) -> ForwardSolution:
        """The pose for joints (n,): from `near` (warm), else from home (cold).

        Raises NoSolution when none is found, or a cold start's answer cannot be trusted.
        """
        ...

    def forward_along(self, joints: Array, near: Pose) -> Pose:
        """The poses (N,) for joints (N, n) in a row, each warm from the one before, first `near`.

        Raises NoSolution where none is found.
        """
        ...

    def jacobian(self, pose: Pose, joints: Array) -> Array:
        """The twist of unit joint rates, (..., 6, n); raises NoSolution where it is singular."""
        ...

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """What to draw of the machine with one pose and its joints (n,)."""
        ...

    def links(self, pose: Pose, joints: Array) -> tuple[Link, ...]:
        """The frames of the moving parts with one pose and its joints (n,), in the base frame."""
        ...

    def sigma_min(self, pose: Pose, joints: Array) -> Array:
        """The singularity margin of `ForwardSolution`, (...)."""
        ...


BRANCH_JUMP = 0.5
"""A step of a joint (rad) between two neighbours that only another branch of the inverse makes."""


def first_jump(joints: Array) -> int | None:
    """The first row of (N, n) from which a joint jumps to the next; None where none does."""
    steps = np.abs(np.diff(joints, axis=0)).max(axis=-1, initial=0.0)
    jumps = np.flatnonzero(steps > BRANCH_JUMP)
    return int(jumps[0]) if jumps.size else None


POSE_NUMBERS = 6
"""A machine with more joints chooses them by a rule: of one pose it can have many."""
DIFFERENCE = 1e-5
"""Of a second."""


def chosen_rates(kinematics: Kinematics, pose: Pose, joints: Array, twist: Array) -> Array:
    """Rates (..., n) of the joints that the inverse chooses for a twist (..., 6) at poses (...).

    By differences; joints (..., n) are those at the poses. NaN where a leg does not close.
    """
    step = DIFFERENCE * twist
    ahead, behind = (kinematics.inverse_or_nan(pose.moved(part), joints) for part in (step, -step))
    rates: Array = (ahead - behind) / (2.0 * DIFFERENCE)
    return rates
