"""The shoulder and elbow of a chain: joints 2 and 3, whose axes are parallel."""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from arm_control.subproblems import distance_angles, facing_angle, projection_angles, rotate
from manipulator.arrays import Array


@dataclass(frozen=True, eq=False)
class TwoLink:
    """Joints 1 to 3 of `chain` bringing `tip`, a point (3,) at zero angles, to its target.

    Joint 1 turns the plane of joints 2 and 3 through the target; those two triangulate it.
    """

    chain: Chain
    tip: Array

    def joint_1(self, target: Array, free: Array) -> Array:
        """Both turns of the arm's plane towards target (..., 3): (..., 2)."""
        axis, across = self.chain.axes[0], self.chain.axes[1]
        origin = self.chain.points[0]
        offset = np.dot(across, self.tip - origin)
        return projection_angles(axis, across, target - origin, offset, free)

    def in_joint_1(self, target: Array, q1: Array) -> Array:
        """The target as joint 1's link sees it: turned back by q1."""
        p1 = self.chain.points[0]
        local: Array = p1 + rotate(self.chain.axes[0], -q1, target - p1)
        return local

    def joint_3(self, target: Array, free: Array) -> Array:
        """Both elbow angles for the target in joint 1's frame (..., 3): (..., 2)."""
        _, p2, p3 = self.chain.points[:3]
        distance = np.linalg.norm(target - p2, axis=-1)
        return distance_angles(self.chain.axes[2], self.tip - p3, p2 - p3, distance, free)

    def joint_2(self, target: Array, q3: Array, free: Array) -> Array:
        """The shoulder angle for the target in joint 1's frame, with the elbow at q3."""
        _, p2, p3 = self.chain.points[:3]
        reached = p3 + rotate(self.chain.axes[2], q3, self.tip - p3) - p2
        return facing_angle(self.chain.axes[1], reached, target - p2, free)

    def joint_1_refusal(self, name: str, target: Array) -> str:
        """How near to joint 1's axis the target (3,) is, and may be."""
        axis, across = self.chain.axes[0], self.chain.axes[1]
        arm = target - self.chain.points[0]
        distance = np.linalg.norm(arm - np.dot(arm, axis) * axis)
        needed = abs(np.dot(across, self.tip - self.chain.points[0]))
        return f"{name} {distance:.4g} m from joint 1's axis, needs at least {needed:.4g} m"

    def elbow_refusal(self, name: str, targets: Array) -> str:
        """How far from the shoulder the best of the targets (k, 3) is, and may be.

        All in joint 1's frame, measured in the plane of the two links.
        """
        across = self.chain.axes[1]
        _, p2, p3 = self.chain.points[:3]
        arms = np.vstack([p3 - p2, self.tip - p3, targets - p2])
        upper, fore, *wanted = np.linalg.norm(arms - np.outer(arms @ across, across), axis=1)
        reach, core = float(upper + fore), float(abs(upper - fore))
        distance = float(min(wanted, key=lambda w: max(w - reach, core - w)))
        bound = f'reach is {reach:.4g} m' if distance > reach else f'needs at least {core:.4g} m'
        return f'{name} {distance:.4g} m from the shoulder, {bound}'


def lattice(joints: tuple[Array, ...]) -> Array:
    """Joints, each (..., 1 or 2, 1 or 2, 1 or 2), as branches (..., 8, n): all NaN or none."""
    grid = np.stack(np.broadcast_arrays(*joints), axis=-1)
    lost = np.isnan(grid).any(axis=-1, keepdims=True)
    result: Array = np.where(lost, np.nan, grid).reshape(*grid.shape[:-4], 8, len(joints))
    return result
