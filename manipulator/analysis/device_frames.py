"""Where the measuring device and its marker are: T_device_base and T_platform_marker.

The device sees M = T_device_base · T_base_platform · T_platform_marker. Both frames are 12 more
parameters: each a shift (m) and a rotation vector (rad) from where they were guessed to be.
"""

from dataclasses import dataclass

import numpy as np

from manipulator import rotation as so3
from manipulator.analysis.measurements import Parameter
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.formatting import counted
from manipulator.pose import Pose

COUNT = 12
GROUPS = ('device', 'marker')
FEWEST = 3


@dataclass(frozen=True, eq=False)
class DeviceFrames:
    """The frames as guessed; `moved` applies the values (12,)."""

    T_device_base: Pose
    T_platform_marker: Pose

    @classmethod
    def known(cls) -> 'DeviceFrames':
        """The device reports the platform's pose in the base frame."""
        return cls(Pose.identity(), Pose.identity())

    @classmethod
    def guessed(cls, nominal: Pose, measured: Pose) -> 'DeviceFrames':
        """From poses (n,) of the platform, as they should be, and those measured.

        In closed form, as in hand-eye calibration (Shah 2013): R_M R_Xᵀ R_Pᵀ = R_Z is linear in
        both rotations, and so are the shifts once these are known. NoSolution where there are
        fewer than three poses, or all are turned alike.
        """
        if len(nominal.position) < FEWEST:
            raise NoSolution(
                f'{counted(len(nominal.position), "pose")}, the frames need {FEWEST} at least'
            )
        R_Z, R_X = _rotations(nominal.rotation, measured.rotation)
        count = len(nominal.position)
        # p_M = R_Z (p_P + R_P p_X) + p_Z
        rows = np.concatenate(
            [np.broadcast_to(np.eye(3), (count, 3, 3)), R_Z @ nominal.rotation], axis=2
        ).reshape(-1, 6)
        target = (measured.position - nominal.position @ R_Z.T).ravel()
        shifts = np.linalg.lstsq(rows, target, rcond=1e-9)[0]
        return cls(Pose(shifts[:3], R_Z), Pose(shifts[3:], R_X))

    @staticmethod
    def parameters() -> tuple[Parameter, ...]:
        """The device's pose is not known beforehand: the tolerances are infinite."""
        return tuple(
            Parameter(f'{frame} {turn}{axis}', group, unit, np.inf)
            for frame, group in (('device frame', 'device'), ('marker frame', 'marker'))
            for turn, unit in (('', 'm'), ('turn about ', 'rad'))
            for axis in 'xyz'
        )

    def moved(self, values: Array) -> 'DeviceFrames':
        """The frames after their values (12,) are applied."""
        return DeviceFrames(
            self.T_device_base.moved(values[:6]), self.T_platform_marker.moved(values[6:])
        )

    def seen(self, platform: Pose) -> Pose:
        """Poses (n,) of the platform in the base frame, as the device sees the marker."""
        return self.T_device_base @ platform @ self.T_platform_marker

    def slopes(self, values: Array, platform: Pose, slopes: Array) -> Array:
        """(n, 6, p + 12): the marker's twists in the device's axes.

        slopes (n, 6, p) are the platform's in the base frame, at the same poses.
        """
        now = self.moved(values)
        R_Z = now.T_device_base.rotation
        arm = platform.rotation @ now.T_platform_marker.position
        turned = R_Z @ slopes[:, 3:]
        shifted = R_Z @ (slopes[:, :3] - so3.skew(arm) @ slopes[:, 3:])
        lever = (platform.position + arm) @ R_Z.T
        R_marker = R_Z @ platform.rotation
        device_turn = so3.left_jacobian(values[3:6])
        marker_turn = so3.left_jacobian(values[9:])
        zero, one = np.zeros((len(lever), 3, 3)), np.broadcast_to(np.eye(3), (len(lever), 3, 3))
        device = _stacked(one, -so3.skew(lever) @ device_turn, zero, zero + device_turn)
        marker = _stacked(R_marker, zero, zero, R_marker @ marker_turn)
        own = np.concatenate([shifted, turned], axis=1)
        return np.concatenate([own, device, marker], axis=2)


def _stacked(a: Array, b: Array, c: Array, d: Array) -> Array:
    return np.concatenate([np.concatenate([a, b], 2), np.concatenate([c, d], 2)], 1)


def _rotations(platform: Array, marker: Array) -> tuple[Array, Array]:
    """R_Z and R_X: row by row, vec(R_Z) = (R_M ⊗ R_P) vec(R_Xᵀ) at every pose.

    So they are the leading singular vectors of the sum over the poses, made rotations.
    """
    total = np.einsum('nij,nkl->ikjl', marker, platform).reshape(9, 9)
    u, s, vt = np.linalg.svd(total)
    if s[0] - s[1] < 1e-9 * s[0]:
        raise NoSolution('all poses have one orientation: the device frame is not determined')
    R_Z, R_X = _rotation(u[:, 0].reshape(3, 3)), _rotation(vt[0].reshape(3, 3))
    return R_Z, R_X.T


def _rotation(matrix: Array) -> Array:
    """The rotation nearest to a matrix, or to its negative."""
    u, _, vt = np.linalg.svd(matrix * np.sign(np.linalg.det(matrix)))
    rotation: Array = u @ vt
    return rotation
