"""The MuJoCo model of a crank platform.

Body frames have the base's axes at home. Each crank turns about its servo, carries its rod by a
universal joint, and a ball joint closes the loop at the platform: 24 freedoms, 18 closures.
"""

import xml.etree.ElementTree as ET

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.rotary import RotaryHexapod
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import RotaryDynamicsConfig
from hexarm.simulation.platform_parts import (
    PLATFORM,
    UniversalJoint,
    add_closure,
    add_drives,
    add_hexagon,
    add_joint,
    add_platform,
    add_rod,
)
from hexarm.simulation.rigid_body import (
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
from manipulator.arrays import Array
from manipulator.pose import Pose

BODY_DEPTH, LEAST_DEPTH = 0.03, 0.01
"""How far the body reaches below the crank axes, and its least thickness, metres."""


def rotary_model(
    name: str,
    kinematics: RotaryHexapod,
    config: RotaryDynamicsConfig,
    drives: Drives,
    minimum_height: float,
) -> Mechanism:
    """The model at home, with the drives of the cranks.

    The body's lid is where a level platform at minimum_height (m), its limit, rests on it.
    """
    geometry, joints = kinematics.geometry, kinematics.joint_names
    root = document(name, config.gravity)
    lid = minimum_height - 0.5e-3 * config.platform.thickness_mm
    _add_body(root, kinematics, config, lid)
    add_platform(root, config.platform, config.payload, geometry.platform_points, geometry.home)
    universals = _universals(kinematics)
    closures = {}
    for leg in range(LEGS):
        _add_leg(root, kinematics, config, drives, leg, universals[leg])
        closures[f'leg {leg + 1}'] = add_closure(root, leg + 1)
    add_drives(root, joints, drives)
    seat = _seat(kinematics, universals)
    unit = kinematics.joint_unit
    return Mechanism(name, written(root), joints, unit, PLATFORM, closures, drives, seat)


def _universals(kinematics: RotaryHexapod) -> tuple[UniversalJoint, ...]:
    """Hinge 1 parallel to the servo's axis, as the bolt at the crank's tip is."""
    home = kinematics.home
    rods = kinematics.unit_rods(home, kinematics.inverse(home))
    normals = kinematics.geometry.normals
    return tuple(UniversalJoint(n, u) for n, u in zip(normals, rods, strict=True))


def _add_body(
    root: ET.Element, kinematics: RotaryHexapod, config: RotaryDynamicsConfig, lid: float
) -> None:
    """The fixed body, a hexagonal prism, and a servo behind each crank.

    The prism reaches up to the lid (m); above a platform that hangs, up from the lowest crank.

    Behind is where the crank's axis leads towards the body, away from the platform's side.
    """
    geometry, world = kinematics.geometry, child(root, 'worldbody')
    middle = 2 * geometry.crank_centres.mean(axis=0) - kinematics.home.position
    reach = np.linalg.norm(geometry.crank_centres[:, :2], axis=1).min()
    body = add(world, 'body', name='body')
    servo = config.servo
    length, radius = 1e-3 * servo.length_mm, 1e-3 * servo.radius_mm
    heights = min(-BODY_DEPTH, lid - LEAST_DEPTH), lid
    if middle[2] > geometry.crank_centres[:, 2].max():
        lowest = float(geometry.crank_centres[:, 2].min())
        heights = lowest, lowest + BODY_DEPTH
    add_hexagon(root, body, 'body', reach - length, heights, METAL)
    for leg in range(LEGS):
        centre, normal = geometry.crank_centres[leg], geometry.normals[leg]
        inward = normal if normal @ (centre - middle) < 0 else -normal
        case = rod(1e-3 * servo.mass_g, radius, centre, centre + length * inward)
        held = add(body, 'body', name=f'servo_{leg + 1}')
        inertial(held, case, np.zeros(3))
        tube(held, centre + 0.15 * length * inward, centre + length * inward, radius, METAL)


def _add_leg(
    root: ET.Element,
    kinematics: RotaryHexapod,
    config: RotaryDynamicsConfig,
    drives: Drives,
    leg: int,
    universal: UniversalJoint,
) -> None:
    geometry, home = kinematics.geometry, kinematics.home
    angles = kinematics.inverse(home)
    centre, tip = geometry.crank_centres[leg], kinematics.crank_tips(angles)[leg]
    end = home.transform(geometry.platform_points)[leg]
    zero, crank = np.zeros(3), config.crank
    turning = add(child(root, 'worldbody'), 'body', name=f'crank_{leg + 1}', pos=centre)
    name = kinematics.joint_names[leg]
    add_joint(turning, name, 'hinge', geometry.normals[leg], float(angles[leg]), drives, leg)
    radius = 1e-3 * crank.radius_mm
    inertial(turning, rod(1e-3 * crank.mass_g, radius, centre, tip), centre)
    tube(turning, zero, tip - centre, radius)
    add_rod(turning, leg + 1, config.rod, (tip - centre, end - centre), universal)


def _seat(kinematics: RotaryHexapod, universals: tuple[UniversalJoint, ...]) -> Seat:
    start = kinematics.inverse(kinematics.home)
    geometry = kinematics.geometry

    def seat(pose: Pose, joints: Array) -> Array:
        rods = kinematics.unit_rods(pose, joints)
        legs = []
        for leg, universal in enumerate(universals):
            in_crank = _turned(rods[leg], geometry.normals[leg], start[leg] - joints[leg])
            legs.append([joints[leg], *universal.angles(in_crank)])
        return np.concatenate([free_body(pose), np.ravel(legs)])

    return seat


def _turned(vector: Array, axis: Array, angle: float) -> Array:
    """Rodrigues' formula."""
    along = axis * (axis @ vector)
    result: Array = (
        along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)
    )
    return result
