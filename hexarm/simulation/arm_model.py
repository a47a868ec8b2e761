"""The MuJoCo model of a serial arm: body frames have the base's axes at zero angles."""

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from arm_control.arm import SerialArm
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import ArmDynamicsConfig
from hexarm.simulation.platform_parts import add_carried, add_drives, add_joint
from hexarm.simulation.rigid_body import (
    BLUE,
    METAL,
    Mechanism,
    RigidBody,
    add,
    child,
    document,
    inertial,
    link,
    tube,
    written,
)
from manipulator.arrays import Array
from manipulator.pose import Pose

TOOL = 'tool'
VISUAL_GROUP = '2'
"""Of MuJoCo's geoms: by convention what is only seen."""


def arm_links(arm: SerialArm, config: ArmDynamicsConfig) -> tuple[RigidBody, ...]:
    """Each joint's link, up to the next joint or the tool; base axes, zero angles."""
    points = [*arm.chain.points, arm.chain.home.position]
    return tuple(
        link(described, begin, end)
        for described, (begin, end) in zip(config.links, pairwise(points), strict=True)
    )


def arm_model(name: str, arm: SerialArm, config: ArmDynamicsConfig, drives: Drives) -> Mechanism:
    """The model at zero angles, with the drives of the joints."""
    chain, root = arm.chain, document(name, config.gravity)
    parent, origin = child(root, 'worldbody'), np.zeros(3)
    points = [*chain.points, chain.home.position]
    tube(parent, origin, points[0], 1e-3 * config.links[0].radius_mm, METAL)
    for i, body in enumerate(arm_links(arm, config)):
        parent = add(parent, 'body', name=f'link_{i + 1}', pos=points[i] - origin)
        origin = points[i]
        add_joint(parent, arm.joint_names[i], 'hinge', chain.axes[i], 0.0, drives, i)
        inertial(parent, body, origin)
        radius = 1e-3 * config.links[i].radius_mm
        tube(parent, np.zeros(3), points[i + 1] - origin, radius, BLUE if i % 2 else METAL)
    x, y, z, w = chain.home.quaternion
    tool = add(
        parent, 'body', name=TOOL, pos=chain.home.position - origin, quat=(w, x, y, z)
    )  # fmt: skip
    add(tool, 'site', name=TOOL)
    add_carried(tool, config.payload)
    add_drives(root, arm.joint_names, drives)

    def seat(pose: Pose, joints: Array) -> Array:
        return joints

    names, unit = arm.joint_names, arm.joint_unit
    return Mechanism(name, written(root), names, unit, TOOL, {}, drives, seat)


def with_meshes(model: Mechanism, arm: SerialArm, files: Sequence[Path | None]) -> Mechanism:
    """The model of an arm with meshes of the base and the links in place of their rods.

    Files are named by their whole paths. A mesh has neither mass nor contacts.
    """
    root = ET.fromstring(model.xml)
    bodies = [child(root, 'worldbody'), *(body for body in root.iter('body') if _is_link(body))]
    origins = [np.zeros(3), *arm.chain.points]
    for i, (body, origin, file) in enumerate(zip(bodies, origins, files, strict=True)):
        if file is None:
            continue
        for rod in body.findall('geom'):
            body.remove(rod)
        name = f'mesh_{i}'
        add(child(root, 'asset'), 'mesh', name=name, file=str(file), inertia='shell')
        add(
            body, 'geom', type='mesh', mesh=name, pos=-origin, mass='0', group=VISUAL_GROUP,
            rgba=BLUE if i % 2 else METAL,
        )  # fmt: skip
    return replace(model, xml=written(root))


def _is_link(body: ET.Element) -> bool:
    return body.get('name', '').startswith('link_')
