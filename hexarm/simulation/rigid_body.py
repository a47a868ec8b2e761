"""Rigid bodies, and the MuJoCo models that are made of them.

Mass, centre and inertia, also of the shapes that estimates are made of; the model's XML, the names
in it, and where a pose puts it.
"""

import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import (
    CarriedConfig,
    LinkConfig,
    PayloadConfig,
    PlateConfig,
    tensor,
)
from manipulator.arrays import Array, frozen
from manipulator.pose import Pose

TOOL_RADIUS = 0.01
"""Metres: the inertia of a tool is estimated as that of a round rod from the platform to it."""
Seat = Callable[[Pose, Array], Array]
"""From a pose and its joints (n,) to the model's coordinates qpos."""


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A model of one machine, before MuJoCo has read it.

    joints' actuators have their names, in the kinematics' order; the body `moving` is the
    platform or tool, with its frame; closures are pairs of sites that the closed loops join, by
    whose they are.
    """

    name: str
    xml: str
    joints: tuple[str, ...]
    joint_unit: str
    moving: str
    closures: dict[str, tuple[str, str]]
    drives: Drives
    seat: Seat


def free_body(pose: Pose) -> Array:
    """The qpos of a free body: position, then the quaternion w, x, y, z."""
    x, y, z, w = pose.quaternion
    return np.concatenate([pose.position, [w, x, y, z]])


@dataclass(frozen=True, eq=False)
class RigidBody:
    """mass in kg, centre (3,) in m, inertia (3, 3) about the centre in kg·m²; one frame's axes."""

    mass: float
    centre: Array
    inertia: Array

    def __post_init__(self) -> None:
        """Freezes the arrays."""
        object.__setattr__(self, 'centre', frozen(self.centre))
        object.__setattr__(self, 'inertia', frozen(self.inertia))

    def with_body(self, other: 'RigidBody') -> 'RigidBody':
        """Both as one body (Steiner's theorem); both in the same frame."""
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        inertia = sum(b.inertia + _steiner(b.mass, b.centre - centre) for b in (self, other))
        return RigidBody(mass, centre, np.asarray(inertia))


def plate(config: PlateConfig, inradius: float) -> RigidBody:
    """The platform in its frame; without an inertia of its own, a hexagon of `inradius` metres."""
    mass, thickness = 1e-3 * config.mass_g, 1e-3 * config.thickness_mm
    if config.inertia_g_mm2 is not None:
        moments = 1e-9 * np.array(config.inertia_g_mm2)
    else:
        side = 2 * inradius / np.sqrt(3)
        across = mass * (5 / 24 * side**2 + thickness**2 / 12)
        moments = np.array([across, across, mass * 5 / 12 * side**2])
    return RigidBody(mass, 1e-3 * np.array(config.centre_mm), np.diag(moments))


def payload(config: PayloadConfig) -> RigidBody:
    """A cylinder on the moving frame's xy plane."""
    mass, radius, height = (1e-3 * v for v in (config.mass_g, config.radius_mm, config.height_mm))
    across = mass * (3 * radius**2 + height**2) / 12
    inertia = np.diag([across, across, mass * radius**2 / 2])
    return RigidBody(mass, np.array([0.0, 0.0, height / 2]), inertia)


def carried_bodies(config: PayloadConfig) -> dict[str, RigidBody]:
    """What of 'payload' and 'tool' weighs anything, in the moving frame."""
    bodies = {'payload': payload(config)} if config.mass_g > 0 else {}
    if isinstance(config, CarriedConfig):
        mass, *centre = config.tool.load
        point = 1e-3 * np.array(config.tool.xyz_mm)
        body = rod(1e-3 * mass, TOOL_RADIUS, np.zeros(3), point)
        bodies['tool'] = RigidBody(body.mass, 1e-3 * np.array(centre), body.inertia)
    return bodies


def rod(mass: float, radius: float, begin: Array, end: Array) -> RigidBody:
    """A round rod of even density between two points; a ball where they coincide."""
    along = np.asarray(end) - np.asarray(begin)
    length = float(np.sqrt(along @ along))
    centre = (np.asarray(begin) + np.asarray(end)) / 2
    if length < radius:
        return RigidBody(mass, centre, 0.4 * mass * radius**2 * np.eye(3))
    axis = np.outer(along, along) / length**2
    across = mass * (3 * radius**2 + length**2) / 12
    inertia = across * (np.eye(3) - axis) + mass * radius**2 / 2 * axis
    return RigidBody(mass, centre, inertia)


def link(config: LinkConfig, begin: Array, end: Array) -> RigidBody:
    """An arm's link between two joints, in base axes at zero angles."""
    body = rod(1e-3 * config.mass_g, 1e-3 * config.radius_mm, begin, end)
    centre, inertia = body.centre, body.inertia
    if config.centre_mm is not None:
        centre = 1e-3 * np.array(config.centre_mm)
    if config.inertia_g_mm2 is not None:
        inertia = 1e-9 * tensor(config.inertia_g_mm2, config.products_g_mm2)
    return RigidBody(body.mass, centre, inertia)


def _steiner(mass: float, offset: Array) -> Array:
    result: Array = mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    return result


TIME_STEP = 0.0005
GREY, METAL, BLUE, ORANGE = (
    '0.55 0.57 0.6 1',
    '0.3 0.32 0.35 1',
    '0.04 0.43 0.6 1',
    '0.82 0.38 0.24 1',
)

Value = str | float | Array | list[float] | tuple[float, ...]


def add(parent: ET.Element, tag: str, **attributes: Value) -> ET.Element:
    """A child element; numbers are written so that they can be read back exactly enough."""
    return ET.SubElement(parent, tag, {k: _text(v) for k, v in attributes.items()})


def document(name: str, gravity: Array) -> ET.Element:
    """The root: radians, SI, no contacts, loops closed stiffly at a step of TIME_STEP.

    gravity (3,) is the acceleration of free fall in the base frame, m/s². MuJoCo's default solref
    and solimp leave millimetres of error in closed loops.
    """
    root = ET.Element('mujoco', model=name)
    add(root, 'compiler', angle='radian', autolimits='true')
    option = add(
        root, 'option', timestep=TIME_STEP, gravity=gravity,
        integrator='implicitfast', iterations='50', tolerance='1e-12',
    )  # fmt: skip
    add(option, 'flag', contact='disable')
    default = add(root, 'default')
    add(default, 'geom', contype='0', conaffinity='0', rgba=GREY)
    add(
        default, 'equality', solref=(2 * TIME_STEP, 1.0), solimp=(0.99, 0.9999, 0.0001)
    )  # fmt: skip
    add(default, 'site', size='0.002', rgba=METAL)
    for part in ('asset', 'worldbody', 'tendon', 'equality', 'actuator'):
        add(root, part)
    add(child(root, 'worldbody'), 'light', pos='0.2 -0.3 1', dir='-0.2 0.3 -1')
    return root


def child(parent: ET.Element, tag: str) -> ET.Element:
    """The one child of that name."""
    found = parent.find(tag)
    if found is None:
        raise KeyError(tag)
    return found


def inertial(parent: ET.Element, body: RigidBody, origin: Array) -> None:
    """The mass of a MuJoCo body whose origin is at `origin` in the frame of `body`."""
    i = body.inertia
    full = (i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
    add(parent, 'inertial', pos=body.centre - origin, mass=body.mass, fullinertia=full)


def tube(parent: ET.Element, begin: Array, end: Array, radius: float, rgba: str = GREY) -> None:
    """A visible round rod; its mass is that of `inertial`."""
    if float(np.linalg.norm(np.asarray(end) - np.asarray(begin))) > 1e-6:
        add(
            parent, 'geom', type='capsule', size=radius, mass='0', rgba=rgba,
            fromto=np.concatenate([begin, end]),
        )  # fmt: skip


def written(root: ET.Element) -> str:
    """The document as text."""
    ET.indent(root)
    return ET.tostring(root, encoding='unicode') + '\n'


def _text(value: Value) -> str:
    if isinstance(value, str):
        return value
    return ' '.join(f'{float(v):.12g}' for v in np.ravel(value))
