"""Closed-form inverse of arms built as the UR5: joints 2, 3, 4 parallel, axes 5 and 6 meeting."""

from dataclasses import dataclass

import numpy as np

from arm_control.chain import Chain
from arm_control.subproblems import facing_angle, perpendicular, projection_angles, rotate
from arm_control.tracking import tracked
from arm_control.two_link import TwoLink, lattice
from manipulator.arrays import Array
from manipulator.pose import Pose


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
