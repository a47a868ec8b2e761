"""The spread of poses that errors cause, to first order and by chance."""

from dataclasses import dataclass

import numpy as np

from manipulator.accuracy.joint_errors import JointErrors
from manipulator.arrays import Array
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class Spread:
    """second_moments (..., 6, 6) of the twist from the pose wanted to the poses got, m and rad.

    About the pose wanted, not about the mean. draws is how many poses it comes from, 0 for the
    linear law.
    """

    second_moments: Array
    draws: int = 0

    @property
    def position_rms(self) -> Array:
        """√E|Δp|² (...), metres."""
        return _root_trace(self.second_moments[..., :3, :3])

    @property
    def angle_rms(self) -> Array:
        """√E angle² (...), radians."""
        return _root_trace(self.second_moments[..., 3:, 3:])

    @property
    def relative_error(self) -> float:
        """Of both, at about 95 % confidence: of n squares that scatter like a χ² of one degree."""
        return 2.0 / np.sqrt(2.0 * self.draws) if self.draws else 0.0

    def __add__(self, other: 'Spread') -> 'Spread':
        """Of two independent causes, to first order."""
        return Spread(self.second_moments + other.second_moments)


def linear_spread(kinematics: Kinematics, pose: Pose, errors: JointErrors) -> Spread:
    """K diag(σ²) Kᵀ with the Jacobian K, at poses (...). NoSolution at a singular pose."""
    jacobian = kinematics.jacobian(pose, kinematics.inverse(pose))
    return linear_law(jacobian, errors.variance)


def linear_law(slopes: Array, variance: Array) -> Spread:
    """From the twist by each of p independent errors (..., 6, p), and their variances (p,)."""
    return Spread((slopes * variance) @ np.swapaxes(slopes, -1, -2))


def drawn_spread(
    kinematics: Kinematics,
    pose: Pose,
    errors: JointErrors,
    count: int,
    generator: np.random.Generator,
) -> Spread:
    """From `count` draws of the joints at one pose, each solved by the forward kinematics."""
    joints = kinematics.inverse(pose) + errors.drawn(count, generator)
    return spread_of(pose, [kinematics.forward(q, pose).pose for q in joints])


def spread_of(wanted: Pose, got: list[Pose]) -> Spread:
    """Of single poses about the one wanted."""
    twists = np.array([wanted.twist_to(pose) for pose in got])
    return Spread(twists.T @ twists / len(got), len(got))


def _root_trace(moments: Array) -> Array:
    result: Array = np.sqrt(np.trace(moments, axis1=-2, axis2=-1))
    return result
