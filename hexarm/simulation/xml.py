"""MuJoCo's XML, written element by element."""

import xml.etree.ElementTree as ET

import numpy as np

from hexarm.simulation.rigid_body import RigidBody
from manipulator.arrays import Array

TIME_STEP = 0.0005
GRAVITY = 9.80665
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


def document(name: str) -> ET.Element:
    """The root: radians, SI, no contacts, loops closed stiffly at a step of TIME_STEP.

    MuJoCo's default solref and solimp leave millimetres of error in closed loops.
    """
    root = ET.Element('mujoco', model=name)
    add(root, 'compiler', angle='radian', autolimits='true')
    option = add(
        root, 'option', timestep=TIME_STEP, gravity=(0.0, 0.0, -GRAVITY),
        integrator='implicitfast', iterations='50', tolerance='1e-12',
    )  # fmt: skip
    add(option, 'flag', contact='disable')
    default = add(root, 'default')
    add(default, 'geom', contype='0', conaffinity='0', rgba=GREY)
    add(
        default, 'equality', solref=(2 * TIME_STEP, 1.0), solimp=(0.99, 0.9999, 0.0001)
    )  # fmt: skip
    add(default, 'site', size='0.002', rgba=METAL)
    for part in ('asset', 'worldbody', 'equality', 'actuator'):
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
    """A round rod to look at; its mass is told by `inertial`."""
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
