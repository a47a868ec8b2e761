"""The MuJoCo model of a serial arm: body frames have the base's axes at zero angles."""

from itertools import pairwise

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
