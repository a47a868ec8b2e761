"""What servos add to the positions that they are sent to."""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen


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
