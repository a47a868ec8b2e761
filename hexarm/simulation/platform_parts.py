"""What parallel platforms have in common as MuJoCo models: plate, payload, drives.

A universal joint is two hinges: the angles that turn a rod from its home to a direction.
"""

import xml.etree.ElementTree as ET
from dataclasses import dataclass, field

import numpy as np

from hexapod_control.geometry import LEGS
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import PayloadConfig, PlateConfig, RodConfig
from hexarm.simulation.rigid_body import (
    BLUE,
    ORANGE,
    RigidBody,
    add,
    carried_bodies,
    child,
    inertial,
    plate,
    rod,
    tube,
)
from manipulator.arrays import Array, frozen
from manipulator.pose import Pose


@dataclass(frozen=True, eq=False)
class UniversalJoint:
    """Hinge 1 about the unit vector first_axis, then hinge 2 about second_axis, which it carries.

    home is the rod's unit direction at zero angles; second_axis is square to it and to hinge 1.
    """

    first_axis: Array
    home: Array
    second_axis: Array = field(init=False)

    def __post_init__(self) -> None:
        """Places the second hinge."""
        second = np.cross(self.first_axis, self.home)
        object.__setattr__(self, 'second_axis', frozen(second / np.linalg.norm(second)))

    @classmethod
    def across(cls, home: Array) -> 'UniversalJoint':
        """With both hinges square to the rod at home."""
        least = np.eye(3)[np.argmin(np.abs(home))]
        first = np.cross(home, least)
        return cls(frozen(first / np.linalg.norm(first)), frozen(home))

    def angles(self, direction: Array) -> Array:
        """Both angles (..., 2) in radians for unit directions (..., 3), hinge 1's carrier's axes.

        Turning about the second axis lowers the part along the first; turning about the first
        leaves that part.
        """
        rise = np.arcsin(np.clip(self.home @ self.first_axis, -1.0, 1.0))
        now = np.arcsin(np.clip(direction @ self.first_axis, -1.0, 1.0))
        out = np.cross(self.second_axis, self.first_axis)
        azimuth = np.arctan2(direction @ self.second_axis, direction @ out)
        return np.stack([azimuth, rise - now], axis=-1)


PLATFORM = 'platform'
PARTS = {'payload': 'payload', 'tool': 'tool_in_force'}
"""Names of the bodies that a machine carries: an arm's own end is 'tool'."""


def inradius(points: Array) -> float:
    """Of the hexagon about joints (6, 3), with faces every 60°, the first towards +x."""
    turns = np.arange(LEGS) * np.pi / 3
    faces = np.stack([np.cos(turns), np.sin(turns)])
    return float((points[:, :2] @ faces).max())


def moving_bodies(
    plate_config: PlateConfig, load: PayloadConfig, points: Array
) -> tuple[RigidBody, ...]:
    """The platform and, when it weighs anything, what it carries; in the platform's frame."""
    return plate(plate_config, inradius(points)), *carried_bodies(load).values()


def add_platform(
    root: ET.Element, plate_config: PlateConfig, load: PayloadConfig, points: Array, home: Pose
) -> None:
    """The free body at home with the platform's frame, a site a joint; the payload fixed to it."""
    x, y, z, w = home.quaternion
    world = child(root, 'worldbody')
    body = add(world, 'body', name=PLATFORM, pos=home.position, quat=(w, x, y, z))
    add(body, 'freejoint', name=PLATFORM)
    inertial(body, plate(plate_config, inradius(points)), np.zeros(3))
    half = 0.5e-3 * plate_config.thickness_mm
    add_hexagon(root, body, PLATFORM, inradius(points), (-half, half), BLUE)
    for leg, point in enumerate(points, start=1):
        add(body, 'site', name=f'joint_{leg}', pos=point)
    add_carried(body, load)


def add_carried(parent: ET.Element, load: PayloadConfig) -> None:
    """What the platform or arm carries, fixed to it: the payload as a cylinder to look at."""
    for name, body in carried_bodies(load).items():
        held = add(parent, 'body', name=PARTS[name], pos=body.centre)
        inertial(held, body, body.centre)
        if name == 'payload':
            size = (1e-3 * load.radius_mm, 0.5e-3 * load.height_mm)
            add(held, 'geom', type='cylinder', size=size, mass='0', rgba=ORANGE)


def add_hexagon(
    root: ET.Element,
    body: ET.Element,
    name: str,
    radius: float,
    heights: tuple[float, float],
    rgba: str,
) -> None:
    """A hexagonal prism to look at, with faces every 60°."""
    corners = (np.arange(LEGS) + 0.5) * np.pi / 3
    outer = 2 * radius / np.sqrt(3)
    ring = np.stack([outer * np.cos(corners), outer * np.sin(corners)], axis=1)
    vertices = np.vstack([np.column_stack([ring, np.full(LEGS, z)]) for z in heights])
    add(child(root, 'asset'), 'mesh', name=name, vertex=vertices)
    add(body, 'geom', type='mesh', mesh=name, mass='0', rgba=rgba)


def add_closure(root: ET.Element, leg: int, how: str = 'connect') -> tuple[str, str]:
    """A ball joint, or a weld, of a leg's end to the platform; returns the sites that meet."""
    pair = (f'end_{leg}', f'joint_{leg}')
    add(child(root, 'equality'), how, name=f'ball_{leg}', site1=pair[0], site2=pair[1])
    return pair


def add_rod(
    carrier: ET.Element,
    leg: int,
    config: RodConfig,
    ends: tuple[Array, Array],
    universal: UniversalJoint,
) -> None:
    """A rod on a universal joint, with the site that meets the platform; ends in carrier axes."""
    begin, along, zero = ends[0], ends[1] - ends[0], np.zeros(3)
    held = add(carrier, 'body', name=f'rod_{leg}', pos=begin)
    add_hinges(held, leg, (universal.first_axis, universal.second_axis))
    radius = 1e-3 * config.radius_mm
    inertial(held, rod(1e-3 * config.mass_g, radius, zero, along), zero)
    tube(held, zero, along, radius)
    add(held, 'site', name=f'end_{leg}', pos=along)


def add_drives(
    root: ET.Element, joints: tuple[str, ...], drives: Drives, moved: str = 'joint'
) -> None:
    """One actuator a joint: a spring towards its target that saturates at the drive's effort.

    moved is what it acts on, of the same name: the joint, or a tendon.
    """
    for name, stiffness, effort in zip(joints, drives.stiffness, drives.effort, strict=True):
        add(
            child(root, 'actuator'), 'general', name=name, **{moved: name}, gainprm=stiffness,
            biastype='affine', biasprm=(0.0, -stiffness, 0.0), forcerange=(-effort, effort),
        )  # fmt: skip


def add_joint(
    body: ET.Element, name: str, kind: str, axis: Array, home: float, drives: Drives, index: int
) -> None:
    """A driven joint whose coordinate is the kinematics' own."""
    add(
        body, 'joint', name=name, type=kind, axis=axis, ref=home,
        damping=drives.damping[index], armature=drives.rotor[index],
    )  # fmt: skip


def add_hinges(body: ET.Element, leg: int, axes: tuple[Array, Array]) -> None:
    """A universal joint without friction."""
    for which, axis in zip('ab', axes, strict=True):
        add(body, 'joint', name=f'universal_{leg}{which}', type='hinge', axis=axis)
