"""Poses: a position in metres and a rotation matrix, alone or in arrays of any shape.

`T_a_b` is the pose of frame b in frame a and maps b's coordinates to a's. A twist is the array
(vx, vy, vz, ωx, ωy, ωz): the velocity of the moving frame's origin, then its angular velocity,
both in the fixed frame's axes, in m/s and rad/s.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from manipulator import _kernel
from manipulator import rotation as so3
from manipulator.arrays import Array, frozen, stretched
from manipulator.errors import InvalidInput


@dataclass(frozen=True, eq=False, slots=True)
class Pose:
    """One rigid displacement, or an array of them: position (..., 3), rotation (..., 3, 3)."""

    position: Array
    rotation: Array

    def __post_init__(self) -> None:
        """Copies, freezes and stretches both arrays to the same leading axes.

        Raises InvalidInput on shapes that do not fit and on NaN, ∞.
        """
        position, rotation = frozen(self.position), frozen(self.rotation)
        if position.shape[-1:] != (3,):
            raise InvalidInput(f'position has shape {position.shape}, needs (..., 3)')
        if rotation.shape[-2:] != (3, 3):
            raise InvalidInput(f'rotation has shape {rotation.shape}, needs (..., 3, 3)')
        if position.shape[:-1] != rotation.shape[:-2]:
            position, rotation = _stretched(position, rotation)
        for name, array in (('position', position), ('rotation', rotation)):
            if not np.isfinite(array).all():
                raise InvalidInput(f'{name} is not finite: {array.ravel()[:9].tolist()}')
            object.__setattr__(self, name, array)

    @classmethod
    def unchecked(cls, position: Array, rotation: Array) -> 'Pose':
        """Takes over two arrays known to be good, without copy or check; they become read-only.

        For inner loops: the caller must not have handed either array to anyone else.
        """
        pose = object.__new__(cls)
        position.setflags(write=False)
        rotation.setflags(write=False)
        object.__setattr__(pose, 'position', position)
        object.__setattr__(pose, 'rotation', rotation)
        return pose

    @classmethod
    def identity(cls) -> 'Pose':
        """The pose of a frame in itself."""
        return cls(np.zeros(3), np.eye(3))

    @classmethod
    def from_xyz_rpy(cls, xyz: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)) -> 'Pose':
        """From metres and roll, pitch, yaw in radians."""
        return cls(np.asarray(xyz, dtype=np.float64), so3.from_rpy(rpy))

    @classmethod
    def from_xyz_quaternion(cls, xyz: ArrayLike, xyzw: ArrayLike) -> 'Pose':
        """From metres and a unit quaternion x, y, z, w."""
        return cls(np.asarray(xyz, dtype=np.float64), so3.from_quaternion(xyzw))

    @property
    def quaternion(self) -> Array:
        """The orientation as x, y, z, w with w ≥ 0."""
        return so3.to_quaternion(self.rotation)

    @property
    def rpy(self) -> Array:
        """The orientation as roll, pitch, yaw in radians."""
        return so3.to_rpy(self.rotation)

    def __repr__(self) -> str:
        """One pose as the call that makes it, to 1 µm and 1 µrad; of an array its shape."""
        leading = self.position.shape[:-1]
        if leading:
            return f'<Pose of shape {leading}>'
        # + 0.0 turns −0 into 0
        xyz, rpy = ((np.round(part, 6) + 0.0).tolist() for part in (self.position, self.rpy))
        return f'Pose.from_xyz_rpy({xyz}, {rpy})'

    def __matmul__(self, other: 'Pose') -> 'Pose':
        """T_a_b @ T_b_c is T_a_c."""
        return Pose(
            self.position + np.einsum('...ij,...j->...i', self.rotation, other.position),
            self.rotation @ other.rotation,
        )

    def __getitem__(self, index: Any) -> 'Pose':
        """One pose, or a slice, of an array of poses."""
        return Pose(self.position[index], self.rotation[index])

    def inverse(self) -> 'Pose':
        """T_b_a of T_a_b."""
        transposed = np.swapaxes(self.rotation, -1, -2)
        return Pose(-np.einsum('...ij,...j->...i', transposed, self.position), transposed)

    def transform(self, points: ArrayLike) -> Array:
        """Points (n, 3) of the inner frame in the outer frame, (..., n, 3)."""
        turned = np.asarray(points, dtype=np.float64) @ np.swapaxes(self.rotation, -1, -2)
        result: Array = turned + self.position[..., None, :]
        return result

    def moved(self, twist: ArrayLike) -> 'Pose':
        """After a unit of time at `twist`, origin and orientation advanced each on its own."""
        step = np.asarray(twist, dtype=np.float64)
        leading = _common(self.position.shape[:-1], step.shape[:-1])
        position, rotation = np.empty((*leading, 3)), np.empty((*leading, 3, 3))
        start = self._stretched(leading)
        if _kernel.moved(*start, stretched(step, (*leading, 6)), position, rotation):
            return Pose(position, rotation)  # raises: not finite
        return Pose.unchecked(position, rotation)

    def twist_to(self, target: 'Pose') -> Array:
        """The twist with which `moved` arrives at `target`; (..., 6)."""
        leading = _common(self.position.shape[:-1], target.position.shape[:-1])
        twist = np.empty((*leading, 6))
        _kernel.twist_between(*self._stretched(leading), *target._stretched(leading), twist)
        return twist

    def _stretched(self, leading: tuple[int, ...]) -> tuple[Array, Array]:
        if self.position.shape[:-1] == leading:
            return self.position, self.rotation
        return stretched(self.position, (*leading, 3)), stretched(self.rotation, (*leading, 3, 3))


def _common(one: tuple[int, ...], other: tuple[int, ...]) -> tuple[int, ...]:
    """The shape that both broadcast to; at once where it is the same."""
    return one if one == other else np.broadcast_shapes(one, other)


def _stretched(position: Array, rotation: Array) -> tuple[Array, Array]:
    """Read-only copies with the leading axes that both broadcast to."""
    try:
        shape = np.broadcast_shapes(position.shape[:-1], rotation.shape[:-2])
    except ValueError as error:
        raise InvalidInput(
            f'position of shape {position.shape} does not fit rotation of shape {rotation.shape}'
        ) from error
    return (
        frozen(np.broadcast_to(position, (*shape, 3))),
        frozen(np.broadcast_to(rotation, (*shape, 3, 3))),
    )
