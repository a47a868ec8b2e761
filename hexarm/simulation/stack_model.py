"""The MuJoCo model of a stack: the models of its sections, each base on the platform below.

Every platform stays a free body, whose six loops close at the ends of its own legs. So a stack of
n crank or linear sections has 24n freedoms and 18n closures.
"""

import xml.etree.ElementTree as ET
from dataclasses import fields

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.stacks.kinematics import StackKinematics
from hexarm.simulation.drives import Drives
from hexarm.simulation.platform_parts import PLATFORM
from hexarm.simulation.rigid_body import Mechanism, Seat, add, child, document, free_body, written
from manipulator.arrays import Array
from manipulator.pose import Pose

NAMES = ('name', 'joint', 'tendon', 'site1', 'site2', 'mesh')
"""Attributes that name something, or refer to it."""
FREE = 7
"""Coordinates of a free body, the first of a section's own model."""


def stack_model(
    name: str, kinematics: StackKinematics, parts: tuple[Mechanism, ...], gravity: Array
) -> Mechanism:
    """The model at home, of the models of the sections from the ground up.

    gravity (3,) is the acceleration of free fall in the lowest base's frame, m/s².
    """
    root = document(name, gravity)
    below, base = child(root, 'worldbody'), Pose.identity()
    closures = {}
    for i, part in enumerate(parts):
        prefix, platform = f'section_{i + 1}_', kinematics.platforms[i]
        top = base @ platform.home
        moving = _put_section(root, below, part, prefix, top)
        base = top @ kinematics.stack.transforms[i]
        is_last = i == len(parts) - 1
        below = _fixed(
            moving,
            PLATFORM if is_last else f'section_{i + 2}_base',
            kinematics.stack.transforms[i],
        )
        for owner, sites in part.closures.items():
            closures[f'section {i + 1} {owner}'] = (prefix + sites[0], prefix + sites[1])
    return Mechanism(
        name,
        written(root),
        kinematics.joint_names,
        kinematics.joint_unit,
        PLATFORM,
        closures,
        _together([part.drives for part in parts]),
        _seat(kinematics, parts),
    )


def _put_section(
    root: ET.Element, below: ET.Element, part: Mechanism, prefix: str, top: Pose
) -> ET.Element:
    """Puts a section's parts on `below`, its platform beside them, at its pose at home."""
    own = ET.fromstring(part.xml)
    for element in own.iter():
        for key in set(NAMES) & set(element.attrib):
            element.set(key, prefix + element.attrib[key])
    bodies = {body.get('name'): body for body in child(own, 'worldbody').findall('body')}
    platform = bodies.pop(prefix + part.moving)
    below.extend(bodies.values())
    _place(platform, top)
    child(root, 'worldbody').append(platform)
    for section in ('asset', 'tendon', 'equality', 'actuator'):
        child(root, section).extend(child(own, section))
    return platform


def _fixed(body: ET.Element, name: str, at: Pose) -> ET.Element:
    held = add(body, 'body', name=name)
    _place(held, at)
    return held


def _place(body: ET.Element, at: Pose) -> None:
    x, y, z, w = at.quaternion
    for key, values in (('pos', at.position), ('quat', (w, x, y, z))):
        body.set(key, ' '.join(f'{float(v):.12g}' for v in values))


def _together(drives: list[Drives]) -> Drives:
    names = [field.name for field in fields(Drives)]
    return Drives(*(np.concatenate([getattr(d, name) for d in drives]) for name in names))


def _seat(kinematics: StackKinematics, parts: tuple[Mechanism, ...]) -> Seat:
    """The legs of a section, then its platform: as MuJoCo counts the tree's joints."""

    def seat(pose: Pose, joints: Array) -> Array:
        coordinates, base = [], Pose.identity()
        for i, at in enumerate(kinematics.sections_of(joints)):
            own = parts[i].seat(at, joints[LEGS * i : LEGS * (i + 1)])
            coordinates += [own[FREE:], free_body(base @ at)]
            base = base @ at @ kinematics.stack.transforms[i]
        return np.concatenate(coordinates)

    return seat
