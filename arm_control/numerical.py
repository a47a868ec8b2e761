"""Inverse of any chain by damped Newton steps from many starts (docs/arm-kinematics.md, 6)."""

from dataclasses import dataclass

import numpy as np

from arm_control.branches import without_repeats
from arm_control.chain import Chain
from arm_control.tracking import tracked_by_newton
from manipulator.arrays import Array
from manipulator.pose import Pose

STEPS = 60
STARTS = 32
TOLERANCE = 1e-10


@dataclass(frozen=True, eq=False)
class Numerical:
    """Levenberg–Marquardt with the error as damping (Sugihara, IEEE T-RO 27(5), 2011).

    length scales metres against radians; low and high span the cold starts.
    """

    chain: Chain
    length: float
    low: Array
    high: Array

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return False

    def branches(self, pose: Pose, near: Array) -> Array:
        """What was found from `near` (entry 0) and from the cold starts: (..., 33, 6).

        A branch may be missed.
        """
        spread = np.random.default_rng(0).uniform(self.low, self.high, (STARTS, 6))
        lead = pose.position.shape[:-1]
        starts = np.concatenate(
            [
                np.broadcast_to(near, (*lead, 6))[..., None, :],
                np.broadcast_to(spread, (*lead, STARTS, 6)),
            ],
            axis=-2,
        )
        joints, error = self.descend(pose, starts)
        return without_repeats(np.where((error < TOLERANCE)[..., None], joints, np.nan))

    def along(self, poses: Pose, near: Array) -> Array:
        """See `InverseMethod`."""
        return tracked_by_newton(self.chain, poses, near, self.branches)

    def refusal(self, pose: Pose) -> str:
        """How near the best attempt came."""
        middle = (self.low + self.high) / 2
        spread = np.random.default_rng(0).uniform(self.low, self.high, (STARTS, 6))
        joints, error = self.descend(pose, np.vstack([middle, spread]))
        miss = self.chain.forward(joints[np.argmin(error)]).twist_to(pose)
        distance, angle = np.linalg.norm(miss[:3]), np.degrees(np.linalg.norm(miss[3:]))
        return f'no joint angles found: the best of {STARTS + 1} starts missed by ' + (
            f'{distance:.4g} m and {angle:.3g}°'
        )

    def descend(self, pose: Pose, joints: Array, steps: int = STEPS) -> tuple[Array, Array]:
        """Joints (..., k, 6) after the steps, and the scaled error that is left of each."""
        goal = Pose(pose.position[..., None, :], pose.rotation[..., None, :, :])
        scale = np.array([1 / self.length] * 3 + [1.0] * 3)
        joints = np.array(joints)
        for _ in range(steps):
            error = scale * self.chain.forward(joints).twist_to(goal)
            size = np.linalg.norm(error, axis=-1)
            if (size < TOLERANCE / 10).all():
                break
            jacobian = scale[:, None] * self.chain.jacobian(joints)
            transposed = np.swapaxes(jacobian, -1, -2)
            damping = np.minimum(size**2 / 2, 0.1)[..., None, None] + 1e-12
            normal = transposed @ jacobian + damping * np.eye(6)
            joints = joints + np.linalg.solve(normal, transposed @ error[..., None])[..., 0]
        error = scale * self.chain.forward(joints).twist_to(goal)
        return joints, np.linalg.norm(error, axis=-1)
