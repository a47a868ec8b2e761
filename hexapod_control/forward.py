"""From six rod lengths to a pose: Newton's method on SE(3), docs/kinematics.md, section 3."""

import math
from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput, NoSolution
from manipulator.kinematics import ForwardSolution
from manipulator.pose import Pose

LARGEST_TURN = 0.6
TOLERANCE = 1e-12
MOST_ITERATIONS = 30
ROWS = (0, 1, 2, 0, 1)


@dataclass(frozen=True, eq=False)
class ForwardByLengths:
    """The pose at which six rods of given lengths join base points and platform points.

    platform_points (6, 3) are in the platform frame, in metres; characteristic_length (metres)
    scales rotations in σmin. Stateless and safe to share. A crank platform is one of these, too,
    with the crank tips as base points.
    """

    platform_points: Array
    characteristic_length: float
    scale: Array = field(init=False)

    def __post_init__(self) -> None:
        """Checks the shape; raises InvalidInput."""
        points = frozen(self.platform_points)
        if points.shape != (6, 3):
            raise InvalidInput(f'platform points have shape {points.shape}, need (6, 3)')
        object.__setattr__(self, 'platform_points', points)
        scale = [1.0] * 3 + [1.0 / self.characteristic_length] * 3
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
        position, turn = start.position, start.rotation.take(ROWS, axis=0)
        points = base_points.take(ROWS, axis=1)
        try:
            for iteration in range(MOST_ITERATIONS + 1):
                jacobian, error = self._rows(points, lengths, position, turn)
                square = float(error.dot(error))
                if square < TOLERANCE * TOLERANCE:
                    sigma = self._trusted_sigma(jacobian, side, margin)
                    pose = Pose.unchecked(position.copy(), turn[:3].copy())
                    residual = max(map(abs, error.tolist()))
                    return ForwardSolution(pose, iteration, residual, sigma)
                if side is None:
                    side = float(np.linalg.det(jacobian))
                step = np.linalg.solve(jacobian, error)
                position, turn = _moved(position, turn, step.tolist())
        except np.linalg.LinAlgError as failure:
            raise NoSolution('forward kinematics met a singular pose') from failure
        raise NoSolution(
            f'forward kinematics found no pose in {MOST_ITERATIONS} iterations: '
            f'the rods miss by {1e3 * math.sqrt(square):.3g} mm'
        )

    def _trusted_sigma(self, jacobian: Array, side: float | None, margin: float) -> float:
        """The σmin of the pose found; NoSolution when it, or the sign of det J, says otherwise."""
        sigma = float(np.linalg.svd(jacobian * self.scale, compute_uv=False)[-1])
        if not sigma >= margin:
            raise NoSolution(f'singularity margin {sigma:.3g} below {margin:.3g}: not trusted')
        if side is not None and side * float(np.linalg.det(jacobian)) <= 0.0:
            raise NoSolution('the pose found lies beyond a singularity of the start')
        return sigma

    def _rows(
        self, points: Array, lengths: Array, position: Array, turn: Array
    ) -> tuple[Array, Array]:
        """The leg Jacobian (6, 6) and by how much each rod is too long, wanted minus actual.

        Columns are x, y, z, x, y, so that slices give the cyclic shifts of a cross product:
        R a × u = R a × (p − b)/ℓ, because rod ρ = R a + p − b.
        """
        arms = self.platform_points.dot(turn.T)
        shift = position.take(ROWS) - points
        jacobian = np.empty((6, 6))
        rod = np.add(arms[:, :3], shift[:, :3], out=jacobian[:, :3])
        moment = np.multiply(arms[:, 1:4], shift[:, 2:], out=jacobian[:, 3:])
        moment -= arms[:, 2:] * shift[:, 1:4]
        actual = np.sqrt((rod * rod).dot(_ONES))
        jacobian /= actual[:, None]
        return jacobian, lengths - actual


_ONES = np.ones(3)


def _moved(position: Array, turn: Array, step: list[float]) -> tuple[Array, Array]:
    """After a Newton step (m, rad), shortened as a whole so that it turns 0.6 rad at most.

    `turn` holds rows 0, 1, 2, 0, 1 of the rotation matrix; the left factor is Rodrigues' formula.
    """
    vx, vy, vz, wx, wy, wz = step
    angle = math.sqrt(wx * wx + wy * wy + wz * wz)
    if not angle < math.inf:
        raise NoSolution('forward kinematics met a singular pose')
    if angle > LARGEST_TURN:
        cut = LARGEST_TURN / angle
        vx, vy, vz, wx, wy, wz = (cut * c for c in step)
        angle = LARGEST_TURN
    if angle > 1e-7:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    else:
        s, c = 1.0, 0.5
    cx, cy, cz = c * wx, c * wy, c * wz
    xy, xz, yz, sx, sy, sz = cx * wy, cx * wz, cy * wz, s * wx, s * wy, s * wz
    first = (1.0 - cy * wy - cz * wz, xy - sz, xz + sy)
    second = (xy + sz, 1.0 - cx * wx - cz * wz, yz - sx)
    third = (xz - sy, yz + sx, 1.0 - cx * wx - cy * wy)
    rotation = np.array((first, second, third, first, second))
    return np.add(position, (vx, vy, vz)), rotation.dot(turn[:3])
