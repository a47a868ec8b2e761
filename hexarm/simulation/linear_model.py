"""The MuJoCo model of a platform on linear legs.

Body frames have the base's axes at home. Each leg is on a universal joint, its piston slides
along it, and a ball joint closes the loop at the platform.
"""

import xml.etree.ElementTree as ET

import numpy as np

from hexapod_control.geometry import LEGS
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
from manipulator.arrays import Array
from manipulator.errors import ConfigError
from manipulator.pose import Pose

PLATE = 0.012
"""Thickness of the base plate, behind its joints, metres."""


def linear_model(
    name: str, kinematics: LinearPlatform, config: LinearDynamicsConfig, drives: Drives
) -> Mechanism:
    """The model at home, with the drives of the legs; ConfigError for legs on screws that turn."""
    geometry, joints = kinematics.geometry, kinematics.joint_names
    if geometry.screw_lead != 0.0:
        lead = 1e3 * geometry.screw_lead
        raise ConfigError(
            [f'geometry.screw_lead_mm: {lead:g}, the model turns no screws: needs 0']
        )
    root = document(name, config.gravity)
    base = add(child(root, 'worldbody'), 'body', name='body')
    heights = geometry.base_points[:, 2]
    low = float(heights.min()) - PLATE
    if geometry.home.position[2] < low:
        low = float(heights.max())
    add_hexagon(root, base, 'body', inradius(geometry.base_points), (low, low + PLATE), METAL)
    add_platform(root, config.platform, config.payload, geometry.platform_points, geometry.home)
    rods = kinematics.unit_rods(kinematics.home, kinematics.inverse(kinematics.home))
    universals = tuple(UniversalJoint.across(u) for u in rods)
    closures = {}
    for leg in range(LEGS):
        _add_leg(root, kinematics, config, drives, leg, universals[leg])
        closures[f'leg {leg + 1}'] = add_closure(root, leg + 1)
    add_drives(root, joints, drives)
    seat = _seat(kinematics, universals)
    unit = kinematics.joint_unit
    return Mechanism(name, written(root), joints, unit, PLATFORM, closures, drives, seat)


def _add_leg(
    root: ET.Element,
    kinematics: LinearPlatform,
    config: LinearDynamicsConfig,
    drives: Drives,
    leg: int,
    universal: UniversalJoint,
) -> None:
    length = float(kinematics.inverse(kinematics.home)[leg])
    base, along = kinematics.geometry.base_points[leg], universal.home
    zero = np.zeros(3)
    standing = add(child(root, 'worldbody'), 'body', name=f'cylinder_{leg + 1}', pos=base)
    add_hinges(standing, leg + 1, (universal.first_axis, universal.second_axis))
    tubes = config.cylinder, config.piston
    cylinder, piston = (1e-3 * t.length_mm * along for t in tubes)
    masses, radii = [1e-3 * t.mass_g for t in tubes], [1e-3 * t.radius_mm for t in tubes]
    inertial(standing, rod(masses[0], radii[0], zero, cylinder), zero)
    tube(standing, zero, cylinder, radii[0], METAL)
    sliding = add(standing, 'body', name=f'piston_{leg + 1}', pos=length * along)
    add_joint(sliding, kinematics.joint_names[leg], 'slide', along, length, drives, leg)
    inertial(sliding, rod(masses[1], radii[1], -piston, zero), zero)
    tube(sliding, -piston, zero, radii[1], GREY)
    add(sliding, 'site', name=f'end_{leg + 1}', pos=zero)


def _seat(kinematics: LinearPlatform, universals: tuple[UniversalJoint, ...]) -> Seat:
    def seat(pose: Pose, joints: Array) -> Array:
        rods = kinematics.unit_rods(pose, joints)
        legs = [
            [*universal.angles(rods[leg]), joints[leg]] for leg, universal in enumerate(universals)
        ]
        return np.concatenate([free_body(pose), np.ravel(legs)])

    return seat
