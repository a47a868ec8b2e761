"""From six rod lengths to a pose: Newton's method on SE(3), docs/kinematics.md, section 3."""

import math
from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput, NoSolution
from manipulator.formatting import length
from manipulator.kinematics import ForwardSolution
from manipulator.pose import Pose

LARGEST_TURN = 0.6
TOLERANCE = 1e-11
MOST_ITERATIONS = 30
XYZXY = (0, 1, 2, 0, 1)
_ONES = np.ones(3)


@dataclass(frozen=True, eq=False)
class ForwardByLengths:
    """The pose at which six rods of given lengths join base points and platform points.

    platform_points (6, 3) are in the platform frame, in metres; characteristic_length (metres)
    scales rotations in σmin. A crank platform is one of these, too, with the crank tips as base
    points. Inside, points are columns, and their rows are x, y, z, x, y, so that slices give the
    cyclic shifts of a cross product.
    """

    platform_points: Array
    characteristic_length: float
    columns: Array = field(init=False)
    scale: Array = field(init=False)

    def __post_init__(self) -> None:
        """Checks the shape; raises InvalidInput."""
        points = frozen(self.platform_points)
        if points.shape != (6, 3):
            raise InvalidInput(f'platform points have shape {points.shape}, need (6, 3)')
        scale = [[1.0]] * 3 + [[1.0 / self.characteristic_length]] * 3
        object.__setattr__(self, 'platform_points', points)
        object.__setattr__(self, 'columns', frozen(np.ascontiguousarray(points.T)))
        object.__setattr__(self, 'scale', frozen(scale))

    def solve(
        self,
        base_points: Array,
        lengths: Array,
        start: Pose,
        side: float | None = None,
        margin: float = 0.0,
    ) -> ForwardSolution:
        """Newton from `start`; base_points (6, 3) and lengths (6,) in metres.

        side is the sign that det J must have, by default that at `start`; margin the least σmin.
        Raises NoSolution when nothing is found, or what is found lies beyond a singularity.
        """
        return self.solve_columns(base_points.T.take(XYZXY, axis=0), lengths, start, side, margin)

    def solve_columns(
        self, base: Array, lengths: Array, start: Pose, side: float | None, margin: float
    ) -> ForwardSolution:
        """As `solve`, with base points as the columns of a (5, 6) array of rows x, y, z, x, y.

        The rods left 1e-11 m apart leave the pose within 1e-11 m / σmin, and that by the
        characteristic length in rad: 3e-8 mm and 5e-10 rad for σmin = 0.3 and 70 mm.
        """
        turn = start.rotation.take(XYZXY, axis=0)
        shift = start.position.take(XYZXY)[:, None] - base
        try:
            for iteration in range(MOST_ITERATIONS + 1):
                transposed, error = _jacobian(turn.dot(self.columns), shift, lengths)
                square = float(error.dot(error))
                if square < TOLERANCE * TOLERANCE:
                    sigma = self._trusted_sigma(transposed, side, margin)
                    pose = Pose.unchecked((shift + base)[:3, 0], turn[:3].copy())
                    residual = max(map(abs, error.tolist()))
                    return ForwardSolution(pose, iteration, residual, sigma)
                if side is None:
                    side = float(np.linalg.det(transposed))
                step = _displacement(*np.linalg.solve(transposed.T, error).tolist())
                turn = step[:, :3].dot(turn[:3])
                shift += step[:, 3:]
        except np.linalg.LinAlgError as failure:
            raise NoSolution('forward kinematics met a singular pose') from failure
        raise NoSolution(
            f'forward kinematics found no pose in {MOST_ITERATIONS} iterations: '
            f'the rods miss by {length(math.sqrt(square), 3)}'
        )

    def _trusted_sigma(self, transposed: Array, side: float | None, margin: float) -> float:
        """The σmin of the pose found; NoSolution when it, or the sign of det J, says otherwise."""
        sigma = float(np.linalg.svd(transposed * self.scale, compute_uv=False)[-1])
        if not sigma >= margin:
            raise NoSolution(f'singularity margin {sigma:.3g} below {margin:.3g}: not trusted')
        if side is not None and side * float(np.linalg.det(transposed)) <= 0.0:
            raise NoSolution('the pose found lies beyond a singularity of the start')
        return sigma


def _jacobian(arms: Array, shift: Array, lengths: Array) -> tuple[Array, Array]:
    """Jᵀ (6, 6), and by how much each rod (6,) must grow.

    arms are R a and shift is p − b, both (5, 6). A rod is ρ = R a + p − b, its row of J is
    (u, R a × u) with u = ρ/|ρ|; R a × ρ = R a × (p − b), which spares a sum.
    """
    transposed = np.empty((6, 6))
    rods = np.add(arms[:3], shift[:3], out=transposed[:3])
    moments = np.multiply(arms[1:4], shift[2:], out=transposed[3:])
    moments -= arms[2:] * shift[1:4]
    actual = np.sqrt(_ONES.dot(rods * rods))
    transposed /= actual
    return transposed, lengths - actual


def _displacement(vx: float, vy: float, vz: float, wx: float, wy: float, wz: float) -> Array:
    """The Newton step (m, rad) as exp(ω), v in four columns, of rows x, y, z, x, y.

    Steps that would turn by more than 0.6 rad are shortened as a whole. Rodrigues' formula.
    """
    angle = math.sqrt(wx * wx + wy * wy + wz * wz)
    if not angle < math.inf:
        raise NoSolution('forward kinematics met a singular pose')
    if angle > LARGEST_TURN:
        cut = LARGEST_TURN / angle
        vx, vy, vz, wx, wy, wz = (cut * part for part in (vx, vy, vz, wx, wy, wz))
        angle = LARGEST_TURN
    s, c = 1.0, 0.5
    if angle > 1e-7:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    cx, cy, cz = c * wx, c * wy, c * wz
    xy, xz, yz, sx, sy, sz = cx * wy, cx * wz, cy * wz, s * wx, s * wy, s * wz
    x_row = (1.0 - cy * wy - cz * wz, xy - sz, xz + sy, vx)
    y_row = (xy + sz, 1.0 - cx * wx - cz * wz, yz - sx, vy)
    z_row = (xz - sy, yz + sx, 1.0 - cx * wx - cy * wy, vz)
    return np.array((x_row, y_row, z_row, x_row, y_row))
