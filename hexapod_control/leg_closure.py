"""The triangle of crank, rod and gap that gives a crank's angle: docs/kinematics.md, section 2."""

from dataclasses import dataclass, field

import numpy as np

from hexapod_control.geometry import LEGS, RotaryGeometry
from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

TURN = 2.0 * np.pi
CHUNK = 2048  # stays in cache, and below where BLAS sets its threads to work


@dataclass(frozen=True, eq=False)
class LegClosure:
    """The inverse of all six legs, for one pose or for N poses at once.

    The gap v = a' − c from crank axis to platform joint, in the coordinates of its own leg
    (normal, tangent, up), is linear in the twelve numbers of the pose, so one matrix product
    serves all legs of all poses. Arrays inside are (6, N), legs first, to be quick over N.
    """

    geometry: RotaryGeometry
    pose_to_gap: Array = field(init=False)
    gap_offset: Array = field(init=False)
    crank: Array = field(init=False)
    length_term: Array = field(init=False)

    def __post_init__(self) -> None:
        """Lays out v·e = Σ eⱼ Rⱼₖ aₖ + e·p − e·c as an (18, 12) matrix and an offset."""
        g = self.geometry
        axes = np.stack([g.normals, g.tangents, g.ups])
        turned = axes[..., :, None] * g.platform_points[:, None, :]
        matrix = np.concatenate([turned.reshape(3, LEGS, 9), axes], axis=-1).reshape(-1, 12)
        offset = -(axes * g.crank_centres).sum(axis=-1).reshape(-1, 1)
        object.__setattr__(self, 'pose_to_gap', frozen(matrix))
        object.__setattr__(self, 'gap_offset', frozen(offset))
        object.__setattr__(self, 'crank', frozen(g.crank_lengths[:, None]))
        lengths = g.crank_lengths**2 - g.rod_lengths**2
        object.__setattr__(self, 'length_term', frozen(lengths[:, None]))

    def gaps(self, pose: Pose) -> Array:
        """The gap v in leg coordinates, (18, N): six along the normal, six the tangent, six up."""
        rotation = pose.rotation.reshape(-1, 9)
        numbers = np.concatenate((rotation, pose.position.reshape(-1, 3)), axis=1)
        gap: Array = self.pose_to_gap.dot(numbers.T)
        gap += self.gap_offset
        return gap

    def angles(self, pose: Pose) -> tuple[Array, Array]:
        """(middle, half), (6, N): the crank angles are middle ± half; NaN where it does not close.

        middle = atan2(z, y) and half = arccos((|v|² + r² − d²) / (2 r EC)), Prokopovich 2019,
        eqs (3)–(11) with signs kept: "+" is the elbow-out branch.
        """
        if pose.position.ndim > 1 and (count := pose.position.size // 3) > CHUNK:
            position, rotation = pose.position.reshape(-1, 3), pose.rotation.reshape(-1, 3, 3)
            starts = range(0, count, CHUNK)
            slices = [(position[k : k + CHUNK], rotation[k : k + CHUNK]) for k in starts]
            parts = [self.angles(Pose.unchecked(*s)) for s in slices]
            middles, halves = zip(*parts, strict=True)
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
