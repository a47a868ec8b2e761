"""A serial arm as URDF: one link a joint, its frame on the joint's axis, base axes at zero.

With that choice every joint's origin is a mere shift, as in `SerialArm.links`, and the tool's own
orientation stands in the fixed joint at the end (http://wiki.ros.org/urdf/XML).
"""

import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np

from arm_control.arm import SerialArm
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.links import PLATFORM

BASE = 'base'
COLOURS = {'metal': '0.3 0.32 0.35 1', 'blue': '0.04 0.43 0.6 1', 'orange': '0.82 0.38 0.24 1'}
SHORTEST = 1e-6
"""Of a link that is drawn, metres."""


def urdf(name: str, arm: SerialArm, radii: Sequence[float], torques: Sequence[float]) -> str:
    """The document; radii (m) of the round rods that are drawn, torques (N m) as effort limits."""
    robot = ET.Element('robot', name=name)
    for material, colour in COLOURS.items():
        ET.SubElement(ET.SubElement(robot, 'material', name=material), 'color', rgba=colour)
    chain = arm.chain
    places = [np.zeros(3), *chain.points, chain.home.position]
    parts = [BASE, *(f'link_{i + 1}' for i in range(len(chain.axes)))]
    widths = [radii[0], *radii]
    for i, part in enumerate(parts):
        link = ET.SubElement(robot, 'link', name=part)
        _rod(link, places[i + 1] - places[i], widths[i], 'metal' if i % 2 == 0 else 'blue')
        if i > 0:
            _cylinder(link, np.zeros(3), chain.axes[i - 1], 1.3 * widths[i], 2.6 * widths[i])
    ET.SubElement(robot, 'link', name=PLATFORM)
    for i, joint_name in enumerate(arm.joint_names):
        kind = 'revolute' if np.isfinite(arm.limits.high[i]) else 'continuous'
        joint = _joint(robot, joint_name, kind, parts[i], parts[i + 1])
        ET.SubElement(joint, 'origin', xyz=_text(places[i + 1] - places[i]), rpy='0 0 0')
        ET.SubElement(joint, 'axis', xyz=_text(chain.axes[i]))
        limit = {'velocity': _text([arm.limits.speed[i]]), 'effort': _text([torques[i]])}
        if kind == 'revolute':
            low, high = (_text([v[i]]) for v in (arm.limits.low, arm.limits.high))
            limit = {'lower': low, 'upper': high, **limit}
        ET.SubElement(joint, 'limit', limit)
    rpy = so3.to_rpy(chain.home.rotation, so3.EXACTLY)
    tool = _joint(robot, 'tool', 'fixed', parts[-1], PLATFORM)
    ET.SubElement(tool, 'origin', xyz=_text(places[-1] - places[-2]), rpy=_text(rpy))
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding='unicode') + '\n'


def _joint(robot: ET.Element, name: str, kind: str, parent: str, child: str) -> ET.Element:
    joint = ET.SubElement(robot, 'joint', name=name, type=kind)
    ET.SubElement(joint, 'parent', link=parent)
    ET.SubElement(joint, 'child', link=child)
    return joint


def _rod(link: ET.Element, end: Array, radius: float, material: str) -> None:
    """A cylinder from the link's origin to `end`, in its axes."""
    length = float(np.linalg.norm(end))
    if length > SHORTEST:
        _cylinder(link, end / 2, end / length, radius, length, material)


def _cylinder(
    link: ET.Element,
    centre: Array,
    along: Array,
    radius: float,
    length: float,
    material: str = 'orange',
) -> None:
    visual = ET.SubElement(link, 'visual')
    ET.SubElement(visual, 'origin', xyz=_text(centre), rpy=_text(_turned_to(along)))
    geometry = ET.SubElement(visual, 'geometry')
    ET.SubElement(geometry, 'cylinder', radius=_text([radius]), length=_text([length]))
    ET.SubElement(visual, 'material', name=material)


def _turned_to(along: Array) -> Array:
    """Roll, pitch, yaw that turn z to the unit vector `along`."""
    x, y, z = along
    return so3.to_rpy(so3.from_rpy((0.0, float(np.arctan2(np.hypot(x, y), z)), np.arctan2(y, x))))


def _text(values: Sequence[float] | Array) -> str:
    return ' '.join(f'{float(value) + 0.0:.15g}' for value in values)
