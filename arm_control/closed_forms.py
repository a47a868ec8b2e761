"""Closed-form inverses: all branches of two kinds of arms (docs/arm-kinematics.md).

Arms whose last three axes meet in one point have eight; so have arms built as the UR5, with
joints 2, 3 and 4 parallel and axes 5 and 6 meeting.
"""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from arm_control.subproblems import (
    TwoLink,
    facing_angle,
    lattice,
    perpendicular,
    projection_angles,
    rotate,
)
from arm_control.tracking import tracked
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


@dataclass(frozen=True, eq=False)
class ParallelAxes:
    """`centre` (3,) is where axes 5 and 6 meet at zero angles (docs/arm-kinematics.md, 5).

    Arrays of branches have three axes before the coordinates: joint 1, wrist, elbow.
    """

    chain: Chain
    centre: Array

    @property
    def is_explicit(self) -> bool:
        """See `InverseMethod`."""
        return True

    def branches(self, pose: Pose, near: Array) -> Array:
        """All eight (..., 8, 6): two of joint 1, times two wrists, times two elbows."""
        displacement = pose @ self.chain.home.inverse()
        frees = [near[..., i, None, None, None] for i in range(6)]
        q1, q5, q6 = self._outer(displacement, frees)
        target, angle = self._inner_targets(displacement, (q1, q5, q6), frees[3])
        elbow = TwoLink(self.chain, self.chain.points[3])
        q3 = elbow.joint_3(target[..., 0, :], frees[2][..., 0])
        q2 = elbow.joint_2(target, q3, frees[1])
        _, sense_3, sense_4 = np.sign(self.chain.axes[1:4] @ self.chain.axes[1])
        q4 = sense_4 * (angle - q2 - sense_3 * q3)
        return lattice((q1, q2, q3, q4, q5, q6))

    def along(self, poses: Pose, near: Array) -> Array:
        """See `InverseMethod`."""
        return tracked(self.branches(poses, near), near)

    def refusal(self, pose: Pose) -> str:
        """Which triangle of the arm does not close: joint 1's, or every elbow's."""
        displacement = pose @ self.chain.home.inverse()
        frees = [np.zeros((1, 1, 1))] * 6
        outer = self._outer(displacement, frees)
        if np.isnan(outer[0]).all():
            centre = displacement.transform(self.centre[None])[0]
            wrist = TwoLink(self.chain, self.centre)
            return wrist.joint_1_refusal('wrist centre', centre)
        target, _ = self._inner_targets(displacement, outer, frees[3])
        elbow = TwoLink(self.chain, self.chain.points[3])
        return elbow.elbow_refusal("joint 4's axis", target.reshape(-1, 3))

    def _outer(self, displacement: Pose, frees: list[Array]) -> tuple[Array, Array, Array]:
        """q1 from the wrist centre's distance to the plane of joints 2 to 4, then q5 and q6.

        Those two bring the normal of that plane, which joints 2 to 4 cannot turn, to its place.
        """
        w1, w2, _, _, w5, w6 = self.chain.axes
        centre = displacement.transform(self.centre[None])[..., 0, :]
        wrist = TwoLink(self.chain, self.centre)
        q1 = wrist.joint_1(centre, frees[0][..., 0, 0, 0])[..., None, None]
        normal = _turned(np.swapaxes(displacement.rotation, -1, -2), rotate(w1, q1, w2))
        rough = projection_angles(w5, w6, w2, (normal @ w6)[..., 0], frees[4][..., 0])
        rough = np.swapaxes(rough, -1, -2)
        q6 = facing_angle(w6, normal, rotate(w5, -rough, w2), frees[5])
        return q1, facing_angle(w5, rotate(w6, q6, normal), w2, rough), q6

    def _inner_targets(
        self, displacement: Pose, outer: tuple[Array, Array, Array], free: Array
    ) -> tuple[Array, Array]:
        """Where joints 2 to 4 must bring joint 4's point, and how far they must turn in all.

        The displacement with joints 1, 5 and 6 taken off, in joint 1's frame.
        """
        q1, q5, q6 = outer
        w1, w2, _, _, w5, w6 = self.chain.axes
        side = perpendicular(w2)
        arm = self.chain.points[3] - self.centre
        point = self.centre + rotate(w6, -q6, rotate(w5, -q5, arm))
        shift = displacement.position[..., None, None, None, :]
        moved = _turned(displacement.rotation, point) + shift
        target = TwoLink(self.chain, self.centre).in_joint_1(moved, q1)
        turned = _turned(displacement.rotation, rotate(w6, -q6, rotate(w5, -q5, side)))
        return target, facing_angle(w2, side, rotate(w1, -q1, turned), free)


def _turned(rotation: Array, vectors: Array) -> Array:
    result: Array = np.einsum('...ij,...abcj->...abci', rotation, vectors)
    return result
