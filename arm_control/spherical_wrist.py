"""Closed-form inverse of arms whose last three axes meet in one point: eight branches."""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from arm_control.subproblems import facing_angle, perpendicular, projection_angles, rotate
from arm_control.tracking import tracked
from arm_control.two_link import TwoLink, lattice
from manipulator.arrays import Array
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class SphericalWrist:
    """Joints 2 and 3 parallel, axes 4, 5, 6 through `centre` (docs/arm-kinematics.md, 4)."""

    chain: Chain
    centre: Array

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return True

    def branches(self, pose: Pose, near: Array) -> Array:
        """All eight (..., 8, 6): two of joint 1, times two elbows, times two wrists."""
        w1, w2, w3 = self.chain.axes[:3]
        displacement = pose @ self.chain.home.inverse()
        centre = displacement.transform(self.centre[None])[..., 0, :]
        arm = TwoLink(self.chain, self.centre)
        q1 = arm.joint_1(centre, near[..., 0])[..., None, None]
        local = arm.in_joint_1(centre[..., None, None, None, :], q1)
        q3 = arm.joint_3(local[..., 0, 0, :], near[..., 2, None])[..., None]
        q2 = arm.joint_2(local, q3, near[..., 1, None, None, None])
        columns = np.swapaxes(displacement.rotation, -1, -2)[..., None, None, None, :, :]
        for axis, angle in ((w1, q1), (w2, q2), (w3, q3)):
            columns = rotate(axis, -angle[..., None], columns)
        return lattice((q1, q2, q3, *self._wrist(columns, near)))

    def along(self, poses: Pose, near: Array) -> Array:
        """See `InverseMethod`."""
        return tracked(self.branches(poses, near), near)

    def refusal(self, pose: Pose) -> str:
        """Which triangle of the arm does not close."""
        centre = (pose @ self.chain.home.inverse()).transform(self.centre[None])[0]
        arm = TwoLink(self.chain, self.centre)
        q1 = arm.joint_1(centre, np.zeros(()))
        if np.isnan(q1).all():
            return arm.joint_1_refusal('wrist centre', centre)
        return arm.elbow_refusal('wrist centre', arm.in_joint_1(centre, q1))

    def _wrist(self, columns: Array, near: Array) -> tuple[Array, Array, Array]:
        """q4, q5, q6 with R4·R5·R6 = R; columns[..., j, :] is R's column j.

        q5 is found once roughly, to choose its branch, then exactly from q4: the arc cosine alone
        is good to 1e-8 rad where the wrist is aligned.
        """
        w4, w5, w6 = self.chain.axes[3:]
        across = perpendicular(w6)
        tool = np.einsum('...ji,j->...i', columns, w6)
        side = np.einsum('...ji,j->...i', columns, across)
        free_4, free_5, free_6 = (near[..., i, None, None] for i in (3, 4, 5))
        rough = projection_angles(w5, w6, w4, tool[..., 0, :] @ w4, free_5)
        q4 = facing_angle(w4, rotate(w5, rough, w6), tool, free_4[..., None])
        q5 = facing_angle(w5, w6, rotate(w4, -q4, tool), rough)
        turned = rotate(w5, -q5, rotate(w4, -q4, side))
        return q4, q5, facing_angle(w6, across, turned, free_6[..., None])
