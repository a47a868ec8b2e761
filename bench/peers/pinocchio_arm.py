"""Pinocchio (`pin`, C++): rigid-body algorithms, on the published UR5."""

import numpy as np
import pinocchio as pin

from bench.peers.arm_library import ArmLibrary, compared, compared_without_closed_form
from bench.peers.published_arms import links
from bench.row import Row
from manipulator.arrays import Array
from manipulator.pose import Pose

STEPS, TOLERANCE = 100, 1e-8


class PinocchioArm:
    """One arm of published_arms.py; Pinocchio has no inverse of its own but shows this loop."""

    def __init__(self, name: str) -> None:
        self.model = pin.Model()
        joint, place = 0, pin.SE3.Identity()
        for k, link in enumerate(links(name)):
            joint = self.model.addJoint(joint, pin.JointModelRZ(), place, f'joint_{k + 1}')
            place = pin.SE3(pin.utils.rotate('x', link.alpha), np.array(link.position))
        kind = pin.FrameType.OP_FRAME
        self.tool = self.model.addFrame(pin.Frame('tool', joint, 0, place, kind))
        self.memory = self.model.createData()

    def forward(self, joints: Array) -> Array:
        return self._placed(joints).homogeneous

    def pose(self, joints: Array) -> Pose:
        placed = self._placed(joints)
        return Pose.unchecked(placed.translation.copy(), placed.rotation.copy())

    def jacobian(self, joints: Array) -> Array:
        frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        return pin.computeFrameJacobian(self.model, self.memory, joints, self.tool, frame)

    def inverse(self, pose: Array, near: Array) -> Array:
        """Damped steps, the damping as small as the error (Levenberg, Marquardt, Sugihara)."""
        goal, joints = pin.SE3(pose), near.copy()
        for _ in range(STEPS):
            error = pin.log6(self._placed(joints).actInv(goal)).vector
            size = error @ error
            if size < TOLERANCE * TOLERANCE:
                break
            frame = pin.ReferenceFrame.LOCAL
            j = pin.computeFrameJacobian(self.model, self.memory, joints, self.tool, frame)
            normal = j.T @ j + (min(size / 2, 0.1) + 1e-12) * np.eye(6)
            joints = joints + np.linalg.solve(normal, j.T @ error)
        return joints

    def _placed(self, joints: Array) -> pin.SE3:
        pin.forwardKinematics(self.model, self.memory, joints)
        return pin.updateFramePlacement(self.model, self.memory, self.tool)


def rows() -> list[Row]:
    arm = PinocchioArm('ur5')
    name = f'Pinocchio {pin.__version__}'
    found = compared(ArmLibrary(name, arm.forward, arm.jacobian, arm.inverse, arm.pose))
    return found + compared_without_closed_form(name, PinocchioArm('skew_puma').inverse)
