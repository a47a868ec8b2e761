"""A serial chain of revolute joints as a product of exponentials (docs/arm-kinematics.md, 1)."""

from dataclasses import dataclass, field
from itertools import accumulate

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.pose import Pose
from manipulator.rotation import skew


@dataclass(frozen=True, eq=False)
class Chain:
    """Joint axes, unit (n, 3), and a point of each, metres (n, 3), in base axes at zero angles.

    home is the tool's pose at zero angles. Angles are in radians, right-handed about the axes.
    """

    axes: Array
    points: Array
    home: Pose
    _sine: Array = field(init=False, repr=False)
    _versine: Array = field(init=False, repr=False)
    _lines: Array = field(init=False, repr=False)
    _tool: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Freezes the arrays and prepares the constant parts of every exponential."""
        axes, points = frozen(self.axes), frozen(self.points)
        k = skew(axes)
        sine, versine = np.zeros((2, len(axes), 4, 4))
        for part, factor in ((sine, k), (versine, k @ k)):
            part[:, :3, :3] = factor
            part[:, :3, 3] = -np.einsum('nij,nj->ni', factor, points)
        lines = np.zeros((len(axes), 4, 2))
        lines[:, :3, 0], lines[:, :3, 1], lines[:, 3, 1] = axes, points, 1.0
        tool = np.eye(4)
        tool[:3, :3], tool[:3, 3] = self.home.rotation, self.home.position
        prepared = {'axes': axes, 'points': points, '_sine': sine, '_versine': versine}
        for name, value in {**prepared, '_lines': lines, '_tool': tool}.items():
            object.__setattr__(self, name, frozen(value))

    def displacements(self, joints: Array) -> Array:
        """How far each link has moved from its place at zero angles: (..., n+1, 4, 4), base first.

        Entry i is E_1·…·E_i with E = I + sin q·[S] + (1 − cos q)·[S]² (Rodrigues' formula; axes
        have no pitch, so it holds for the 4 × 4 matrices as well).
        """
        sine = np.sin(joints)[..., None, None]
        versine = (1.0 - np.cos(joints))[..., None, None]
        exponentials = _IDENTITY + sine * self._sine + versine * self._versine
        if joints.ndim == 1:
            return np.array([_IDENTITY, *accumulate(exponentials, np.dot)])
        count = len(self.axes)
        moved = np.empty((*joints.shape[:-1], count + 1, 4, 4))
        moved[..., 0, :, :] = _IDENTITY
        for i in range(count):
            np.matmul(moved[..., i, :, :], exponentials[..., i, :, :], out=moved[..., i + 1, :, :])
        return moved

    def forward(self, joints: Array) -> Pose:
        """The tool's pose in the base frame for joints (..., n)."""
        tool = self.displacements(np.asarray(joints, dtype=np.float64))[..., -1, :, :] @ self._tool
        return Pose(tool[..., :3, 3], tool[..., :3, :3])

    def jacobian(self, joints: Array) -> Array:
        """The tool point's twist in base axes (v, ω) of unit joint rates: (..., 6, n).

        Column i is (a_i × (t − p_i), a_i), with the axis a_i, its point p_i and the tool point t
        where the joints have taken them.
        """
        moved = self.displacements(joints)
        lines = moved[..., :-1, :, :] @ self._lines
        tool = moved[..., -1, :3, :] @ self._tool[:, 3]
        axis = np.swapaxes(lines[..., :3, 0], -1, -2)
        arm = tool[..., :, None] - np.swapaxes(lines[..., :3, 1], -1, -2)
        jacobian = np.empty((*joints.shape[:-1], 6, len(self.axes)))
        x, y, z = axis[..., 0, :], axis[..., 1, :], axis[..., 2, :]
        rx, ry, rz = arm[..., 0, :], arm[..., 1, :], arm[..., 2, :]
        jacobian[..., 0, :] = y * rz - z * ry
        jacobian[..., 1, :] = z * rx - x * rz
        jacobian[..., 2, :] = x * ry - y * rx
        jacobian[..., 3:, :] = axis
        return jacobian


_IDENTITY = frozen(np.eye(4))
