"""URDF, read strictly: links with their masses, joints with their limits (wiki.ros.org/urdf/XML).

Plain URDF, as xacro writes it. Every other element is left alone; document types and entities are
refused, and so is what no machine could be made of.
"""

import math
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import ConfigError
from manipulator.formatting import counted, not_one_of, shown
from manipulator.pose import Pose

T = TypeVar('T')
MAX_CHARACTERS = 5_000_000
MOST_LINKS = 2000
SHORTEST_AXIS = 1e-6
ORIGIN = (0.0, 0.0, 0.0)
ALMOST_RIGHT = 1e-4
"""Radians: 1.57 is out by 8e-4, and may be meant; 1.571 by 2e-4."""
XACRO = 'ros.org/wiki/xacro'
KINDS = ('fixed', 'revolute', 'continuous', 'prismatic', 'planar', 'floating')


@dataclass(frozen=True, eq=False)
class Inertial:
    """mass in kg, centre (3,) in m, inertia (3, 3) about the centre in kg·m²; one frame's axes."""

    mass: float
    centre: Array
    inertia: Array

    def moved(self, pose: Pose) -> 'Inertial':
        """In the axes of the frame in which its own frame has this pose."""
        turned = pose.rotation @ self.inertia @ pose.rotation.T
        centre = pose.rotation @ self.centre + pose.position
        return Inertial(self.mass, centre, turned)

    def joined(self, other: 'Inertial') -> 'Inertial':
        """Both as one body (Steiner's theorem); both in the same frame, and one with a mass."""
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        inertia = np.zeros((3, 3))
        for body in (self, other):
            away = body.centre - centre
            about = away @ away * np.eye(3) - np.outer(away, away)
            inertia += body.inertia + body.mass * about
        return Inertial(mass, centre, inertia)


@dataclass(frozen=True, eq=False)
class UrdfJoint:
    """A joint and the frames that it joins; numbers are None where the file has none.

    origin is T_parent_child at zero; axis, of unit length, is in its axes. Limits in rad, rad/s
    and N·m (or m, m/s, N). mimics is the joint that this one follows, '' for none.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    axis: Array
    lower: float | None = None
    upper: float | None = None
    velocity: float | None = None
    effort: float | None = None
    mimics: str = ''


@dataclass(frozen=True, eq=False)
class Visual:
    """A mesh that shows a link: its file as the URDF names it, its scale (3,) in m a unit.

    place is T_link_mesh, or T_base_mesh at zero where an arm has it.
    """

    file: str
    scale: Array
    place: Pose


@dataclass(frozen=True, eq=False)
class UrdfRobot:
    """All links by name, with what they weigh and their meshes, and all joints.

    In the order of the file.
    """

    name: str
    bodies: dict[str, Inertial | None]
    joints: tuple[UrdfJoint, ...]
    visuals: dict[str, tuple[Visual, ...]]


def read_urdf(text: str) -> UrdfRobot:
    """A robot of the text; ConfigError lists everything that is wrong with it."""
    root, problems = _root(text), list[str]()
    count = len(root.findall('link'))
    if count > MOST_LINKS:
        raise ConfigError([f'{count} links, at most {MOST_LINKS} are read'])
    links = _named(root, 'link', _link, problems)
    joints = _named(root, 'joint', _joint, problems)
    for joint in joints.values():
        ends = {'parent': joint.parent, 'child': joint.child}
        problems += [
            f'joint {shown(joint.name)}: its {end} {shown(link)} is no link of the file'
            for end, link in ends.items()
            if link not in links
        ]
    if problems:
        raise ConfigError(problems)
    bodies = {name: body for name, (body, _) in links.items()}
    visuals = {name: meshes for name, (_, meshes) in links.items()}
    return UrdfRobot(root.get('name', ''), bodies, tuple(joints.values()), visuals)


def with_right_angles(robot: UrdfRobot) -> UrdfRobot:
    """The robot with frames that lie along each other's axes exactly, where they almost do.

    Many files round a right angle to 1.5708, which takes parallel and meeting axes apart, and so
    the closed form from the inverse kinematics.
    """

    def along_axes(origin: Pose) -> Pose:
        along = np.round(origin.rotation)
        is_almost = np.abs(origin.rotation - along).max() < ALMOST_RIGHT
        return Pose(origin.position, along) if is_almost else origin

    joints = (replace(joint, origin=along_axes(joint.origin)) for joint in robot.joints)
    return replace(robot, joints=tuple(joints))


class _Strict(ET.TreeBuilder):
    """Refuses a document type, before any of its entities exists."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        """Called by the parser."""
        raise ConfigError(['has a document type (<!DOCTYPE …>), which no URDF needs'])


def _root(text: str) -> ET.Element:
    if len(text) > MAX_CHARACTERS:
        raise ConfigError([f'{len(text)} characters, at most {MAX_CHARACTERS} are read'])
    try:
        parser = ET.XMLParser(target=_Strict())
        root: ET.Element = ET.fromstring(text.lstrip('\ufeff \t\r\n'), parser)
    except ET.ParseError as error:
        raise ConfigError([f'is not XML: {error}']) from error
    macros = [element.tag for element in root.iter() if XACRO in element.tag]
    is_used = '${' in text or any(not tag.endswith('}property') for tag in macros)
    if macros and is_used:
        raise ConfigError(['is xacro, needs plain URDF: run  xacro FILE > arm.urdf  first'])
    if root.tag != 'robot':
        raise ConfigError([f'its root is {shown(root.tag)}, needs <robot> (URDF)'])
    return root


def _named(
    root: ET.Element, kind: str, read: Callable[[str, ET.Element], T], problems: list[str]
) -> dict[str, T]:
    """What `read` makes of each element of a kind, by name; what is wrong goes to `problems`."""
    found: dict[str, T] = {}
    for element in root.findall(kind):
        name = element.get('name', '')
        owner = f'{kind} {shown(name)}'
        if not name or name in found:
            problems.append(f'{owner}: {"is there twice" if name else "has no name"}')
            continue
        try:
            found[name] = read(name, element)
        except ConfigError as error:
            problems += [f'{owner}: {problem}' for problem in error.problems]
    return found


def _link(name: str, link: ET.Element) -> tuple[Inertial | None, tuple[Visual, ...]]:
    meshes = []
    for visual in link.findall('visual'):
        mesh = visual.find('geometry/mesh')
        if mesh is not None:
            scale = np.array(_numbers(mesh, 'scale', (1.0, 1.0, 1.0)))
            meshes.append(Visual(mesh.get('filename', ''), scale, _origin(visual)))
    return _inertial(link), tuple(meshes)


def _inertial(link: ET.Element) -> Inertial | None:
    """In the link's axes; None where nothing, or a mass of zero, is given."""
    found = link.find('inertial')
    mass = None if found is None else _number(found.find('mass'), 'value')
    if found is None or mass is None or mass == 0.0:
        return None
    if mass < 0.0:
        raise ConfigError([f'mass {mass:g} kg is negative'])
    tensor, inertia = found.find('inertia'), np.zeros((3, 3))
    for row, column in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
        key = 'i' + 'xyz'[row] + 'xyz'[column]
        inertia[row, column] = inertia[column, row] = _number(tensor, key) or 0.0
    return Inertial(mass, np.zeros(3), inertia).moved(_origin(found))


def _joint(name: str, element: ET.Element) -> UrdfJoint:
    kind = element.get('type', '')
    if kind not in KINDS:
        raise ConfigError([f'type {not_one_of(kind, KINDS)}'])
    parent, child = (_attribute(element.find(end), 'link') for end in ('parent', 'child'))
    limit, mimic = element.find('limit'), element.find('mimic')
    keys = ('lower', 'upper', 'velocity', 'effort')
    lower, upper, velocity, effort = (_number(limit, key) for key in keys)
    return UrdfJoint(
        name, kind, parent, child, _origin(element),
        _axis(element.find('axis') if kind != 'fixed' else None),
        lower, upper, velocity, effort, '' if mimic is None else mimic.get('joint', '?'),
    )  # fmt: skip


def _axis(element: ET.Element | None) -> Array:
    """Of unit length; x where none is given."""
    given = np.array(_numbers(element, 'xyz', (1.0, 0.0, 0.0)))
    length = float(np.linalg.norm(given))
    if length < SHORTEST_AXIS:
        raise ConfigError([f'axis {given.tolist()} has no direction'])
    unit: Array = given / length
    return unit


def _origin(element: ET.Element) -> Pose:
    found = element.find('origin')
    return Pose.from_xyz_rpy(_numbers(found, 'xyz', ORIGIN), _numbers(found, 'rpy', ORIGIN))


def _attribute(element: ET.Element | None, key: str) -> str:
    return '' if element is None else element.get(key, '')


def _number(element: ET.Element | None, key: str) -> float | None:
    if element is None or key not in element.attrib:
        return None
    return _numbers(element, key, (0.0,))[0]


def _numbers(
    element: ET.Element | None, key: str, default: tuple[float, ...]
) -> tuple[float, ...]:
    """As many as the default has; ConfigError for another count, and for what is not finite."""
    if element is None or key not in element.attrib:
        return default
    text = element.attrib[key]
    try:
        numbers = tuple(float(word) for word in text.split())
    except ValueError:
        numbers = ()
    if len(numbers) != len(default) or not all(map(math.isfinite, numbers)):
        needed = counted(len(default), 'finite number')
        raise ConfigError([f'{key} of {element.tag} is {shown(text)}, needs {needed}'])
    return numbers
