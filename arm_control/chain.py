"""A serial chain of revolute joints as a product of exponentials (docs/arm-kinematics.md, 1)."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy import ascontiguousarray, empty, float64

from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.pose import Pose

JOINTS = 6


@dataclass(frozen=True, eq=False)
class Chain:
    """Joint axes, unit (6, 3), and a point of each, metres (6, 3), in base axes at zero angles.

    home is the tool's pose at zero angles. Angles are in radians, right-handed about the axes.
    numbers are all these in the order of `struct chain` (kernel/chain.h).
    """

    axes: Array
    points: Array
    home: Pose
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        axes, points = frozen(self.axes), frozen(self.points)
        tool = self.home.position, self.home.rotation
        numbers = frozen(np.concatenate([part.ravel() for part in (axes, points, *tool)]))
        for name, value in (('axes', axes), ('points', points), ('numbers', numbers)):
            object.__setattr__(self, name, value)

    def displacements(self, joints: Array) -> Array:
        """How far each link has moved from its place at zero angles: (..., 7, 4, 4), base first.

        Entry i is E_1·…·E_i.
        """
        angles = ascontiguousarray(joints, float64)
        moved = empty((*angles.shape[:-1], JOINTS + 1, 4, 4))
        _kernel.chain_displacements(self.numbers, angles, moved)
        return moved

    def forward(self, joints: Array) -> Pose:
        """The tool's pose in the base frame for joints (..., 6)."""
        angles = ascontiguousarray(joints, float64)
        if angles.ndim == 1:  # computed at every tick: no shapes are put together
            position, rotation = empty(3), empty((3, 3))
        else:
            lead = angles.shape[:-1]
            position, rotation = empty((*lead, 3)), empty((*lead, 3, 3))
        if _kernel.chain_forward(self.numbers, angles, position, rotation):
            return Pose(position, rotation)  # raises: not finite
        return Pose.unchecked(position, rotation)

    def jacobian(self, joints: Array) -> Array:
        """The tool point's twist in base axes (v, ω) of unit joint rates: (..., 6, 6)."""
        angles = ascontiguousarray(joints, float64)
        jacobian = empty((6, 6) if angles.ndim == 1 else (*angles.shape[:-1], 6, 6))
        _kernel.chain_jacobian(self.numbers, angles, jacobian)
        return jacobian

    def sigma_min(self, joints: Array, length: float) -> Array:
        """The Jacobian's smallest singular value (...), its metres divided by `length` (m).

        NaN for joints that are not finite.
        """
        angles = ascontiguousarray(joints, float64)
        sigma = empty(angles.shape[:-1])
        _kernel.chain_sigma_min(self.numbers, np.array([length]), angles, sigma)
        return sigma


def aligned(pose: Pose, joints: Array) -> tuple[Array, Array, Array]:
    """Position, rotation and joints (..., 6), stretched to the same leading axes, contiguous."""
    position, rotation = pose.position, pose.rotation
    lead = position.shape[:-1]
    if joints.shape[:-1] != lead:
        lead = np.broadcast_shapes(lead, joints.shape[:-1])
    return (
        stretched(position, (*lead, 3)),
        stretched(rotation, (*lead, 3, 3)),
        stretched(joints, (*lead, JOINTS)),
    )


def flat(arrays: tuple[Array, ...]) -> list[Array]:
    """Positions, rotations and joints (..., 3; 3, 3; 6) in one row each."""
    positions = arrays[0].shape[:-1]
    return [array.reshape(-1, *array.shape[len(positions) :]) for array in arrays]


PART = 512
"""Poses of one call: 50 ms where an arm has no closed form, and then Ctrl-C is received."""


def in_parts(function: Callable[..., int], numbers: Array, *arrays: Array) -> int:
    """The sum of what the kernel returns for arrays of poses, joints or results (N, ...)."""
    total = 0
    for start in range(0, len(arrays[0]), PART):
        total += function(numbers, *(array[start : start + PART] for array in arrays))
    return total
