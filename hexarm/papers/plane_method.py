"""Forward kinematics by the plane of the platform: Lapikov et al. 2014, sections 2.2 and 3.2.

The unknowns are the nine coordinates of three points: the platform's joints of a 6-3, or of a 6-6
the corners of the triangle U V W that arises when the sides B1B2, B3B4, B5B6 are prolonged. Three
sides and six legs give nine equations, solved by a trust-region dogleg method.
"""

from dataclasses import dataclass

import numpy as np

from hexapod_control.linear_geometry import PlatesConfig
from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution
from manipulator.pose import Pose

MOST_ITERATIONS = 200
TOLERANCE = 1e-13
FROM_CORNER = np.array([0, 1, 1, 2, 2, 0])  # joint k lies on the side from this corner
TO_CORNER = np.array([1, 0, 2, 1, 0, 2])  # to this one, eqs (15) to (20)


@dataclass(frozen=True)
class PlaneSolution:
    """A pose, the iterations it took, and the worst leg's error in metres."""

    pose: Pose
    iterations: int
    residual: float


@dataclass(frozen=True, eq=False)
class PlaneMethod:
    """A 6-3 or 6-6 platform by the paper's parameters, in metres and radians.

    base_points (6, 3) are in the base frame. platform_angle 0 is the 6-3, whose U, V, W are its
    joints. The platform's frame stands joint_height above their plane.
    """

    base_points: Array
    platform_radius: float
    platform_angle: float
    joint_height: float

    @classmethod
    def of(cls, plates: PlatesConfig) -> 'PlaneMethod':
        """The method for a machine file's geometry; ConfigError as `PlatesConfig.geometry`."""
        return cls(
            plates.geometry().base_points,
            plates.platform_radius_mm * 1e-3,
            float(np.radians(plates.platform_angle_deg)),
            plates.platform_joint_height_mm * 1e-3,
        )

    @property
    def side(self) -> float:
        """UV, eq. (13)."""
        r, phi = self.platform_radius, self.platform_angle
        return float(4 * r * np.sin(phi) + 2 * r * np.sin(np.pi / 3 - phi))

    @property
    def share(self) -> float:
        """K of eqs (14) to (20): how far along its side each joint lies from its corner."""
        return float(2 * self.platform_radius * np.sin(self.platform_angle) / self.side)

    def solve(self, lengths: Array, start: Pose) -> PlaneSolution:
        """The pose with leg lengths (6,) metres that a descent from `start` finds.

        Raises NoSolution when there is none there.
        """
        corners, iterations = self._descend(self._corners(start), frozen(lengths))
        joints = self._joints(corners)
        reached = np.linalg.norm(joints - self.base_points, axis=1)
        return PlaneSolution(
            self._pose(corners), iterations, float(np.abs(reached - lengths).max())
        )

    def _corners(self, pose: Pose) -> Array:
        """U, V, W (3, 3) of a pose: corners at 0°, 120°, 240° of a circle of radius UV/√3."""
        angles = np.arange(3) * 2 * np.pi / 3
        radius = self.side / np.sqrt(3)
        height = np.full(3, -self.joint_height)
        flat = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), height])
        return pose.transform(flat)

    def _joints(self, corners: Array) -> Array:
        """B1 … B6 (6, 3), eqs (15) to (20)."""
        joints: Array = (1 - self.share) * corners[FROM_CORNER] + self.share * corners[TO_CORNER]
        return joints

    def _pose(self, corners: Array) -> Pose:
        """Eqs (5) to (12): z is the plane's normal, x points from the centroid to U."""
        u, v, w = corners
        normal = np.cross(v - u, w - u)
        z = normal / np.linalg.norm(normal)
        centre = corners.mean(axis=0)
        x = (u - centre) / np.linalg.norm(u - centre)
        return Pose(centre + self.joint_height * z, np.column_stack([x, np.cross(z, x), z]))

    def _equations(self, x: Array, lengths: Array) -> tuple[Array, Array]:
        """The nine equations and their Jacobian at corners x (9,), in units of UV²."""
        corners = x.reshape(3, 3)
        rods = self._joints(corners) - self.base_points
        sides = corners - corners[[1, 2, 0]]
        square = self.side**2
        values = np.concatenate(
            [np.sum(sides**2, axis=1) - square, np.sum(rods**2, axis=1) - lengths**2]
        )
        jacobian = np.zeros((9, 3, 3))
        row = np.arange(3)
        jacobian[row, row], jacobian[row, [1, 2, 0]] = 2 * sides, -2 * sides
        row = np.arange(6)
        jacobian[row + 3, FROM_CORNER] = 2 * (1 - self.share) * rods
        jacobian[row + 3, TO_CORNER] = 2 * self.share * rods
        return values / square, jacobian.reshape(9, 9) / square

    def _descend(self, corners: Array, lengths: Array) -> tuple[Array, int]:
        """Powell's dogleg: the corners at which all nine equations hold, and the iterations."""
        x = corners.ravel()
        radius = self.side
        values, jacobian = self._equations(x, lengths)
        for iteration in range(MOST_ITERATIONS):
            if np.abs(values).max() < TOLERANCE * (1 + (lengths.max() / self.side) ** 2):
                return x.reshape(3, 3), iteration
            step = dogleg_step(values, jacobian, radius)
            tried, tried_jacobian = self._equations(x + step, lengths)
            before = float(values @ values)
            predicted = before - float(np.sum((values + jacobian @ step) ** 2))
            gained = before - float(tried @ tried)
            if predicted <= 0.0 or radius < 1e-14 * self.side:
                break
            if gained < 0.25 * predicted:
                radius = float(np.linalg.norm(step)) / 4
            elif gained > 0.75 * predicted:
                radius = max(radius, 2 * float(np.linalg.norm(step)))
            if gained > 0.0:
                x, values, jacobian = x + step, tried, tried_jacobian
        raise NoSolution(
            f'the plane method found no pose: an equation misses by '
            f'{np.abs(values).max():.3g} of the squared side'
        )


def dogleg_step(values: Array, jacobian: Array, radius: float) -> Array:
    """Powell's step of length ≤ radius for values + jacobian·step ≈ 0: (n,), (n, n) to (n,).

    The Newton step where it fits; else the way to it by the steepest descent's minimum, cut off.
    """
    newton = np.asarray(np.linalg.lstsq(jacobian, -values, rcond=None)[0], dtype=np.float64)
    if np.linalg.norm(newton) <= radius:
        return newton
    gradient = jacobian.T @ values
    bent = jacobian @ gradient
    cauchy: Array = -gradient * float(gradient @ gradient) / float(bent @ bent)
    length = float(np.linalg.norm(cauchy))
    if length >= radius:
        return cauchy * (radius / length)
    onward = newton - cauchy
    a, b, c = float(onward @ onward), float(cauchy @ onward), length**2 - radius**2
    share = (-b + np.sqrt(b * b - a * c)) / a
    return np.asarray(cauchy + share * onward, dtype=np.float64)
