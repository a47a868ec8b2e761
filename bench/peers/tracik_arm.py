"""TRAC-IK (`pytracik`, C++): Newton and quadratic programs from seeds, on the published arms."""

import tempfile
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from trac_ik import TracIK

from bench.peers.arm_library import ArmLibrary, compared, compared_without_closed_form
from bench.peers.published_arms import links
from bench.row import Row
from manipulator.arrays import Array


class TracIkArm:
    """With its own defaults: 5 ms and 1e-5 m or rad at most, the first solution that it finds."""

    def __init__(self, name: str) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / 'arm.urdf'
            file.write_text(urdf(name))
            self.solver = TracIK('link_0', 'tool', str(file))

    def forward(self, joints: Array) -> Array:
        pose = np.eye(4)
        pose[:3, 3], pose[:3, :3] = self.solver.fk(joints)
        return pose

    def inverse(self, pose: Array, near: Array) -> Array | None:
        found = self.solver.ik(pose[:3, 3], pose[:3, :3], near)
        return None if found is None else np.array(found)


def urdf(name: str) -> str:
    """The published arm, each joint with one whole turn."""
    root = ElementTree.Element('robot', name=name)
    ElementTree.SubElement(root, 'link', name='link_0')
    origin = {'xyz': '0 0 0', 'rpy': '0 0 0'}
    for k, link in enumerate(links(name), start=1):
        joint = _joint(root, f'joint_{k}', 'revolute', f'link_{k - 1}', f'link_{k}', origin)
        ElementTree.SubElement(joint, 'axis', xyz='0 0 1')
        limit = {'lower': f'{-2 * np.pi}', 'upper': f'{2 * np.pi}', 'velocity': '1', 'effort': '1'}
        ElementTree.SubElement(joint, 'limit', limit)
        origin = {'xyz': ' '.join(map(repr, link.position)), 'rpy': f'{link.alpha!r} 0 0'}
    _joint(root, 'fixed', 'fixed', 'link_6', 'tool', origin)
    return ElementTree.tostring(root, encoding='unicode')


def _joint(
    root: ElementTree.Element,
    name: str,
    kind: str,
    parent: str,
    child: str,
    origin: dict[str, str],
) -> ElementTree.Element:
    ElementTree.SubElement(root, 'link', name=child)
    joint = ElementTree.SubElement(root, 'joint', name=name, type=kind)
    ElementTree.SubElement(joint, 'parent', link=parent)
    ElementTree.SubElement(joint, 'child', link=child)
    ElementTree.SubElement(joint, 'origin', origin)
    return joint


def rows() -> list[Row]:
    arm, name = TracIkArm('ur5'), f'TRAC-IK {version("pytracik")}'
    found = compared(ArmLibrary(name, arm.forward, None, arm.inverse))
    return found + compared_without_closed_form(name, TracIkArm('skew_puma').inverse)
