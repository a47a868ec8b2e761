"""Forward kinematics by the plane of the platform: Lapikov et al. 2014, sections 2.2 and 3.2.

The unknowns are the nine coordinates of three points: the platform's joints of a 6-3, or of a 6-6
the corners of the triangle U V W that arises when the sides B1B2, B3B4, B5B6 are prolonged. Three
sides and six legs give nine equations, solved by a dogleg method: Powell's hybrid of MINPACK.
"""

from dataclasses import dataclass

import numpy as np

from hexapod_control.linear_geometry import PlatesConfig
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.pose import Pose

TOLERANCE = 1e-13
"""Of a step, relative: the last one where it is as small."""
LEAST_SQUARES_TOLERANCE = 1e-15
MOST_LEFT = 1e-12
"""Of an equation, in units of UV²."""
FROM_CORNER = np.array([0, 1, 1, 2, 2, 0])  # joint k lies on the side from this corner
TO_CORNER = np.array([1, 0, 2, 1, 0, 2])  # to this one, eqs (15) to (20)


@dataclass(frozen=True)
class PlaneSolution:
    """A pose, how often the equations were asked for it, and the worst leg's error in metres."""

    pose: Pose
    evaluations: int
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
        from scipy.optimize import root  # noqa: PLC0415 (50 MB: for who asks)

        found = root(
            self._equations, self._corners(start).ravel(), (lengths,), jac=True, tol=TOLERANCE
        )
        worst = np.abs(found.fun).max()
        if worst > MOST_LEFT * (1 + (np.max(lengths) / self.side) ** 2):
            raise NoSolution(
                f'the plane method found no pose: an equation misses by '
                f'{worst:.3g} of the squared side'
            )
        return self._solution(found.x.reshape(3, 3), lengths, int(found.nfev))

    def nearest(self, lengths: Array, start: Pose) -> PlaneSolution:
        """The pose that fits the nine equations best in the sense of least squares, from `start`.

        For lengths (6,) metres that belong to no pose; where the legs do not determine the pose,
        one of the many, by the descent.
        """
        from scipy.optimize import least_squares  # noqa: PLC0415 (50 MB: for who asks)

        found = least_squares(
            lambda x: self._equations(x, lengths)[0],
            self._corners(start).ravel(),
            lambda x: self._equations(x, lengths)[1],
            method='dogbox',
            **dict.fromkeys(('xtol', 'ftol', 'gtol'), LEAST_SQUARES_TOLERANCE),
        )
        return self._solution(found.x.reshape(3, 3), lengths, int(found.nfev))

    def _solution(self, corners: Array, lengths: Array, evaluations: int) -> PlaneSolution:
        reached = np.linalg.norm(self._joints(corners) - self.base_points, axis=1)
        worst = float(np.abs(reached - lengths).max())
        return PlaneSolution(self._pose(corners), evaluations, worst)

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
