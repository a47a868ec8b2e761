"""The MuJoCo model of a platform on linear legs.

Body frames have the base's axes at home. Each leg is on a universal joint, its piston slides
along it, and a ball joint closes the loop at the platform. A screw turns as well: it ends in a
cardan joint that is welded to the platform, and its drive acts on q of docs/kinematics.md, (8.2).
"""

import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS, unit_vectors
from hexapod_control.linear import LinearPlatform
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import LinearDynamicsConfig
from hexarm.simulation.platform_parts import (
    PLATFORM,
    UniversalJoint,
    add_closure,
    add_drives,
    add_hexagon,
    add_hinges,
    add_joint,
    add_platform,
    inradius,
)
from hexarm.simulation.rigid_body import (
    GREY,
    METAL,
    Mechanism,
    Seat,
    add,
    child,
    document,
    free_body,
    inertial,
    rod,
    tube,
    written,
)
from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.pose import Pose

PLATE = 0.012
"""Thickness of the base plate, behind its joints, metres."""
EYE_MASS, EYE_RADIUS, EYE_INERTIA = 1e-6, 2e-3, 1e-8
"""Of the ball, kg and m, that a screw's cardan joint is, and about each of its axes, kg·m².

Too little to be noticed; of nothing, MuJoCo could not compute the motion.
"""


def linear_model(
    name: str, kinematics: LinearPlatform, config: LinearDynamicsConfig, drives: Drives
) -> Mechanism:
    """The model at home, with the drives of the legs."""
    geometry, joints = kinematics.geometry, kinematics.joint_names
    root = document(name, config.gravity)
    base = add(child(root, 'worldbody'), 'body', name='body')
    heights = geometry.base_points[:, 2]
    low = float(heights.min()) - PLATE
    if geometry.home.position[2] < low:
        low = float(heights.max())
    add_hexagon(root, base, 'body', inradius(geometry.base_points), (low, low + PLATE), METAL)
    add_platform(root, config.platform, config.payload, geometry.platform_points, geometry.home)
    rods = kinematics.unit_rods(kinematics.home, kinematics.inverse(kinematics.home))
    screws = _screws(kinematics, rods) if geometry.screw_lead != 0.0 else ()
    universals = tuple(s.base for s in screws) or tuple(UniversalJoint.across(u) for u in rods)
    closures = {}
    for leg in range(LEGS):
        end = _add_leg(root, kinematics, config, drives, leg, universals[leg])
        if screws:
            _add_screw(root, end, screws[leg], leg, drives)
        closures[f'leg {leg + 1}'] = add_closure(root, leg + 1, 'weld' if screws else 'connect')
    add_drives(root, joints, drives, 'tendon' if screws else 'joint')
    seat = _seat(kinematics, universals, screws)
    unit = kinematics.joint_unit
    return Mechanism(name, written(root), joints, unit, PLATFORM, closures, drives, seat)


def _add_leg(
    root: ET.Element,
    kinematics: LinearPlatform,
    config: LinearDynamicsConfig,
    drives: Drives,
    leg: int,
    universal: UniversalJoint,
) -> ET.Element:
    """Returns the piston's body, whose origin is the joint on the platform."""
    geometry, home = kinematics.geometry, kinematics.home
    base, along = geometry.base_points[leg], universal.home
    length = float((home.transform(geometry.platform_points)[leg] - base) @ along)
    zero = np.zeros(3)
    standing = add(child(root, 'worldbody'), 'body', name=f'cylinder_{leg + 1}', pos=base)
    add_hinges(standing, leg + 1, (universal.first_axis, universal.second_axis))
    tubes = config.cylinder, config.piston
    cylinder, piston = (1e-3 * t.length_mm * along for t in tubes)
    masses, radii = [1e-3 * t.mass_g for t in tubes], [1e-3 * t.radius_mm for t in tubes]
    inertial(standing, rod(masses[0], radii[0], zero, cylinder), zero)
    tube(standing, zero, cylinder, radii[0], METAL)
    sliding = add(standing, 'body', name=f'piston_{leg + 1}', pos=length * along)
    name = kinematics.joint_names[leg]
    if geometry.screw_lead == 0.0:
        add_joint(sliding, name, 'slide', along, length, drives, leg)
        add(sliding, 'site', name=f'end_{leg + 1}', pos=zero)
    else:
        add(sliding, 'joint', name=name, type='slide', axis=along, ref=length)
    inertial(sliding, rod(masses[1], radii[1], -piston, zero), zero)
    tube(sliding, -piston, zero, radii[1], GREY)
    return sliding


@dataclass(frozen=True, eq=False)
class _Screw:
    """Of one leg: the cardan joints at its ends, base axes at home; its turn (rad) at home.

    The upper one's first axis is the leg, about which the screw turns; its home is the axis fixed
    to the platform. pitch is metres of the leg by radians of that turn.
    """

    base: UniversalJoint
    end: UniversalJoint
    turn: float
    pitch: float
    home: Pose

    def angles(self, pose: Pose, base_angles: Array) -> Array:
        """The screw's turn, the cross's and the fork's (3,) at a platform's pose."""
        by_base = (self.base.first_axis, self.base.second_axis)
        by_end = (self.end.first_axis, self.end.second_axis)
        turned = _turned(by_base, base_angles).T @ pose.rotation @ self.home.rotation.T
        angles = self.end.angles(turned @ self.end.home)
        rest = so3.log(_turned(by_end, angles).T @ turned)
        return np.array([angles[0] + self.turn, angles[1], rest @ self.end.home])


def _screws(kinematics: LinearPlatform, rods: Array) -> tuple[_Screw, ...]:
    geometry, home, names = kinematics.geometry, kinematics.home, ('base axes', 'platform axes')
    below = unit_vectors(geometry.base_axes, names[0])
    above = unit_vectors(geometry.platform_axes, names[1]) @ home.rotation.T
    pitch = geometry.screw_lead / (2 * np.pi)
    turns = kinematics.legs.screw_turns(home)[0] / pitch
    return tuple(
        _Screw(
            UniversalJoint(below[leg], rods[leg]),
            UniversalJoint(rods[leg], above[leg]),
            float(turns[leg]),
            pitch,
            home,
        )
        for leg in range(LEGS)
    )


def _turned(axes: tuple[Array, Array], angles: Array) -> Array:
    """The rotation (3, 3) about the first axis, then about the second, which it carries."""
    first, second = (angle * axis for axis, angle in zip(axes, angles, strict=True))
    result: Array = so3.exp(first) @ so3.exp(second)
    return result


def _add_screw(
    root: ET.Element, piston: ET.Element, screw: _Screw, leg: int, drives: Drives
) -> None:
    """The screw's turn and its cardan joint at the platform; what its drive moves, a tendon."""
    x, y, z, w = screw.home.quaternion
    eye = add(piston, 'body', name=f'eye_{leg + 1}')
    names = [f'{of}_{leg + 1}' for of in ('turn', 'cross', 'fork')]
    axes = (screw.end.first_axis, screw.end.second_axis, screw.end.home)
    for name, axis in zip(names, axes, strict=True):
        ref = screw.turn if axis is screw.end.first_axis else 0.0
        add(eye, 'joint', name=name, type='hinge', axis=axis, ref=ref, armature=EYE_INERTIA)
    inertial(eye, rod(EYE_MASS, EYE_RADIUS, np.zeros(3), np.zeros(3)), np.zeros(3))
    add(eye, 'site', name=f'end_{leg + 1}', quat=(w, x, y, z))
    slide = piston.find('joint')
    name = '' if slide is None else str(slide.get('name'))
    moved = add(
        child(root, 'tendon'), 'fixed', name=name,
        damping=drives.damping[leg], armature=drives.rotor[leg],
    )  # fmt: skip
    add(moved, 'joint', joint=name, coef=1.0)
    add(moved, 'joint', joint=names[0], coef=screw.pitch)


def _seat(
    kinematics: LinearPlatform,
    universals: tuple[UniversalJoint, ...],
    screws: tuple[_Screw, ...],
) -> Seat:
    def seat(pose: Pose, joints: Array) -> Array:
        rods, legs = kinematics.unit_rods(pose, joints), []
        extra = kinematics.legs.screw_turns(pose)[0] if screws else np.zeros(LEGS)
        for leg, universal in enumerate(universals):
            angles = universal.angles(rods[leg])
            legs += [*angles, joints[leg] - extra[leg]]
            if screws:
                legs += [*screws[leg].angles(pose, angles)]
        return np.concatenate([free_body(pose), legs])

    return seat
