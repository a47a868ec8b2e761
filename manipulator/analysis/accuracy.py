"""How exact a pose is: the errors of joints, and the spread of poses that they cause.

The spread is computed to first order and by chance.
"""

from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class JointErrors:
    """Errors of n joints, rad or m; noise, dead_band and hysteresis are (n,), 0 for none.

    noise: uniform within ±noise. dead_band: the servo rests anywhere within it, uniform within
    ±dead_band/2. hysteresis: the play in its gear is taken up on one side, ±hysteresis/2 with
    equal chances. These are independent from joint to joint. shared (k, n): k signals, uniform
    within ±1, of which each reaches every joint with a weight of its own, rad or m: one row is a
    noise common to all, several make any correlation.
    """

    noise: Array
    dead_band: Array
    hysteresis: Array
    shared: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def __post_init__(self) -> None:
        """Freezes the arrays; raises InvalidInput for weights of another number of joints."""
        for name in ('noise', 'dead_band', 'hysteresis'):
            object.__setattr__(self, name, frozen(getattr(self, name)))
        count = len(self.noise)
        shared = self.shared if self.shared.size else np.zeros((0, count))
        if shared.ndim != 2 or shared.shape[1] != count:
            raise InvalidInput(f'shared errors of shape {shared.shape}, needs (signals, {count})')
        object.__setattr__(self, 'shared', frozen(shared))

    @classmethod
    def of(
        cls, joints: int, noise: float = 0.0, dead_band: float = 0.0, hysteresis: float = 0.0
    ) -> 'JointErrors':
        """The same for all joints."""
        return cls(*(np.full(joints, size) for size in (noise, dead_band, hysteresis)))

    @classmethod
    def common(cls, weights: Array) -> 'JointErrors':
        """One signal that reaches every joint with its weight (n,), rad or m."""
        zero = np.zeros(len(weights))
        return cls(zero, zero, zero, np.array([weights]))

    def on(self, chosen: tuple[int, ...]) -> 'JointErrors':
        """The same errors, on some joints (counted from 0) alone."""
        kept = np.isin(np.arange(len(self.noise)), chosen)
        parts = (self.noise, self.dead_band, self.hysteresis, self.shared)
        return JointErrors(*(part * kept for part in parts))

    @property
    def covariance(self) -> Array:
        """Of the joints (n, n): a²/3 for uniform ±a, b² for ±b, wᵀw/3 for shared signals."""
        uniform = self.noise**2 + (self.dead_band / 2) ** 2
        own = np.diag(uniform / 3 + (self.hysteresis / 2) ** 2)
        result: Array = own + self.shared.T @ self.shared / 3
        return result

    def drawn(self, count: int, generator: np.random.Generator) -> Array:
        """`count` draws (count, n)."""
        shape = (count, len(self.noise))
        noise = generator.uniform(-1.0, 1.0, shape) * self.noise
        rest = generator.uniform(-0.5, 0.5, shape) * self.dead_band
        own = noise + rest + generator.choice([-0.5, 0.5], shape) * self.hysteresis
        result: Array = own + generator.uniform(-1.0, 1.0, (count, len(self.shared))) @ self.shared
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
    """K Σ Kᵀ with the Jacobian K, at poses (...). NoSolution at a singular pose."""
    jacobian = kinematics.jacobian(pose, kinematics.inverse(pose))
    return Spread(jacobian @ errors.covariance @ np.swapaxes(jacobian, -1, -2))


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
