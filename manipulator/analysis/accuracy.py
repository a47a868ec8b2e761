"""How exact a pose is: the errors of joints, and the spread of poses that they cause.

The spread is computed to first order and by chance.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class JointErrors:
    """Independent errors of n joints, rad or m; each array is (n,), 0 for none.

    noise: uniform within ±noise. dead_band: the servo rests anywhere within it, uniform within
    ±dead_band/2. hysteresis: the play in its gear is taken up on one side, ±hysteresis/2 with
    equal chances.
    """

    noise: Array
    dead_band: Array
    hysteresis: Array

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        for name in ('noise', 'dead_band', 'hysteresis'):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @classmethod
    def of(
        cls, joints: int, noise: float = 0.0, dead_band: float = 0.0, hysteresis: float = 0.0
    ) -> 'JointErrors':
        """The same for all joints."""
        return cls(*(np.full(joints, size) for size in (noise, dead_band, hysteresis)))

    def on(self, chosen: tuple[int, ...]) -> 'JointErrors':
        """The same errors, on some joints (counted from 0) alone."""
        kept = np.isin(np.arange(len(self.noise)), chosen)
        return JointErrors(self.noise * kept, self.dead_band * kept, self.hysteresis * kept)

    @property
    def variance(self) -> Array:
        """Of each joint (n,): a²/3 for uniform ±a, b² for ±b."""
        uniform = self.noise**2 + (self.dead_band / 2) ** 2
        result: Array = uniform / 3 + (self.hysteresis / 2) ** 2
        return result

    def drawn(self, count: int, generator: np.random.Generator) -> Array:
        """`count` draws (count, n)."""
        shape = (count, len(self.noise))
        noise = generator.uniform(-1.0, 1.0, shape) * self.noise
        rest = generator.uniform(-0.5, 0.5, shape) * self.dead_band
        result: Array = noise + rest + generator.choice([-0.5, 0.5], shape) * self.hysteresis
        return result


@dataclass(frozen=True, eq=False)
class Spread:
    """second_moments (..., 6, 6) of the twist from the target pose to the poses got, m and rad.

    About the target pose, not about the mean. draws is how many poses it comes from, 0 for the
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


def spread_of(target: Pose, got: list[Pose]) -> Spread:
    """Of single poses about the target."""
    twists = np.array([target.twist_to(pose) for pose in got])
    return Spread(twists.T @ twists / len(got), len(got))


def _root_trace(moments: Array) -> Array:
    result: Array = np.sqrt(np.trace(moments, axis1=-2, axis2=-1))
    return result
