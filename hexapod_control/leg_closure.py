"""The triangle of crank, rod and gap that gives a crank's angle: docs/kinematics.md, section 2."""

from dataclasses import dataclass, field

import numpy as np

from hexapod_control.geometry import LEGS, RotaryGeometry
from hexapod_control.linear import CHUNK, LegGaps, chunks
from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

TURN = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class LegClosure:
    """The inverse of all six legs, for one pose or for N poses at once.

    Works on the gaps from crank axes to platform joints, in leg coordinates (normal, tangent, up).
    Arrays inside are (6, N), legs first, to be quick over N.
    """

    geometry: RotaryGeometry
    gaps: LegGaps = field(init=False)
    crank: Array = field(init=False)
    length_term: Array = field(init=False)

    def __post_init__(self) -> None:
        """Lays out what is the same for every pose."""
        g = self.geometry
        axes = np.stack([g.normals, g.tangents, g.ups])
        object.__setattr__(self, 'gaps', LegGaps(axes, g.crank_centres, g.platform_points))
        object.__setattr__(self, 'crank', frozen(g.crank_lengths[:, None]))
        lengths = g.crank_lengths**2 - g.rod_lengths**2
        object.__setattr__(self, 'length_term', frozen(lengths[:, None]))

    def angles(self, pose: Pose) -> tuple[Array, Array]:
        """(middle, half), (6, N): the crank angles are middle ± half; NaN where it does not close.

        middle = atan2(z, y) and half = arccos((|v|² + r² − d²) / (2 r EC)), Prokopovich 2019,
        eqs (3)–(11) with signs kept: "+" is the elbow-out branch.
        """
        if pose.position.ndim > 1 and pose.position.size > 3 * CHUNK:
            middles, halves = zip(*map(self.angles, chunks(pose)), strict=True)
            return np.concatenate(middles, axis=1), np.concatenate(halves, axis=1)
        gap = self.gaps(pose)
        squares = gap * gap
        in_plane = squares[LEGS : 2 * LEGS] + squares[2 * LEGS :]
        numerator = in_plane + squares[:LEGS]
        numerator += self.length_term
        with np.errstate(invalid='ignore', divide='ignore'):
            half = np.arccos(numerator / ((2.0 * self.crank) * np.sqrt(in_plane)))
        return np.arctan2(gap[2 * LEGS :], gap[LEGS : 2 * LEGS]), half

    def rod_span(self, pose: Pose) -> tuple[Array, Array]:
        """The shortest and longest rods (6, N), in metres, that could join crank and platform.

        The platform joint's distance to the circle of the crank's tip, over all crank angles.
        """
        squares = self.gaps(pose) ** 2
        in_plane = np.sqrt(squares[LEGS : 2 * LEGS] + squares[2 * LEGS :])
        return (
            np.sqrt(squares[:LEGS] + (in_plane - self.crank) ** 2),
            np.sqrt(squares[:LEGS] + (in_plane + self.crank) ** 2),
        )

    def rod_misfit(self, pose: Pose) -> tuple[Array, Array]:
        """(..., 6) each, metres: shortest rod that would do − rod, and rod − longest."""
        shape = (*pose.position.shape[:-1], LEGS)
        shortest, longest = (span.T.reshape(shape) for span in self.rod_span(pose))
        lengths = self.geometry.rod_lengths
        return shortest - lengths, lengths - longest
