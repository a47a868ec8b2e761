"""mink: differential inverse kinematics by quadratic programs on MuJoCo, on the published UR5."""

from importlib.metadata import version
from xml.etree import ElementTree

import mink
import mujoco
import numpy as np

from bench.peers.arm_library import ArmLibrary, compared
from bench.peers.published_arms import links
from bench.row import Row
from manipulator.arrays import Array

STEPS, TOLERANCE = 100, 1e-7
SOLVER = 'daqp'


class MinkArm:
    """mink solves for velocities; for a pose its examples take steps of dt = 1 until it is there.

    Its damping is as small as the task's, so that the last steps are Newton's.
    """

    def __init__(self) -> None:
        model = mujoco.MjModel.from_xml_string(mjcf('ur5'))
        self.configuration = mink.Configuration(model)
        self.task = mink.FrameTask('tool', 'site', 1.0, 1.0, lm_damping=1e-2)

    def forward(self, joints: Array) -> Array:
        self.configuration.update(joints)
        return self.configuration.get_transform_frame_to_world('tool', 'site').as_matrix()

    def jacobian(self, joints: Array) -> Array:
        """mink gives it in the tool's own axes; turned into the base's here."""
        self.configuration.update(joints)
        pose = self.configuration.get_transform_frame_to_world('tool', 'site')
        turn = pose.rotation().as_matrix()
        return np.kron(np.eye(2), turn) @ self.configuration.get_frame_jacobian('tool', 'site')

    def inverse(self, pose: Array, near: Array) -> Array:
        self.configuration.update(near)
        self.task.set_target(mink.SE3.from_matrix(pose))
        for _ in range(STEPS):
            if np.abs(self.task.compute_error(self.configuration)).max() < TOLERANCE:
                break
            rates = mink.solve_ik(
                self.configuration, [self.task], 1.0, SOLVER, damping=1e-12, limits=[]
            )
            self.configuration.integrate_inplace(rates, 1.0)
        return self.configuration.q.copy()


def mjcf(name: str) -> str:
    """The published arm as a MuJoCo model; masses do not matter here."""
    root = ElementTree.Element('mujoco')
    ElementTree.SubElement(root, 'compiler', angle='radian')
    body = ElementTree.SubElement(root, 'worldbody')
    place = {}
    for k, link in enumerate(links(name)):
        body = ElementTree.SubElement(body, 'body', place)
        ElementTree.SubElement(body, 'joint', name=f'joint_{k + 1}', axis='0 0 1')
        ElementTree.SubElement(body, 'inertial', pos='0 0 0', mass='1', diaginertia='1 1 1')
        half = link.alpha / 2
        quaternion = f'{np.cos(half):.17g} {np.sin(half):.17g} 0 0'
        place = {'pos': ' '.join(map(repr, link.position)), 'quat': quaternion}
    ElementTree.SubElement(body, 'site', place, name='tool')
    return ElementTree.tostring(root, encoding='unicode')


def rows() -> list[Row]:
    arm = MinkArm()
    name = f'mink {version("mink")}'
    return compared(ArmLibrary(name, arm.forward, arm.jacobian, arm.inverse))
