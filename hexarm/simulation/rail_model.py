"""The MuJoCo model of a platform on rails.

Body frames have the base's axes at home. Each carriage slides on its rail and carries its rod by a
universal joint; a ball joint closes the loop at the platform.
"""

import xml.etree.ElementTree as ET

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.rails import RailPlatform
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import RailDynamicsConfig
from hexarm.simulation.platform_parts import (
    PLATFORM,
    UniversalJoint,
    add_closure,
    add_drives,
    add_joint,
    add_platform,
    add_rod,
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
from manipulator.pose import Pose

RAIL = 0.3
"""Radius of rails by that of carriages."""


def rail_model(
    name: str, kinematics: RailPlatform, config: RailDynamicsConfig, drives: Drives
) -> Mechanism:
    """The model at home, with the drives of the carriages."""
    geometry, joints, home = kinematics.geometry, kinematics.joint_names, kinematics.home
    root = document(name, config.gravity)
    base = add(child(root, 'worldbody'), 'body', name='body')
    for begin, end in kinematics.rail_ends:
        tube(base, begin, end, RAIL * 1e-3 * config.carriage.radius_mm, METAL)
    add_platform(root, config.platform, config.payload, geometry.platform_points, geometry.home)
    units = kinematics.unit_rods(home, kinematics.inverse(home))
    universals = tuple(UniversalJoint.across(unit) for unit in units)
    closures = {}
    for leg in range(LEGS):
        _add_leg(root, kinematics, config, drives, leg, universals[leg])
        closures[f'leg {leg + 1}'] = add_closure(root, leg + 1)
    add_drives(root, joints, drives)
    seat, unit = _seat(kinematics, universals), kinematics.joint_unit
    return Mechanism(name, written(root), joints, unit, PLATFORM, closures, drives, seat)


def _add_leg(
    root: ET.Element,
    kinematics: RailPlatform,
    config: RailDynamicsConfig,
    drives: Drives,
    leg: int,
    universal: UniversalJoint,
) -> None:
    home, zero = kinematics.home, np.zeros(3)
    joints = kinematics.inverse(home)
    begin = kinematics.base_points(joints)[leg]
    end = home.transform(kinematics.geometry.platform_points)[leg]
    along, block = kinematics.geometry.directions[leg], config.carriage
    half, radius = 0.5e-3 * block.length_mm * along, 1e-3 * block.radius_mm
    sliding = add(child(root, 'worldbody'), 'body', name=f'carriage_{leg + 1}', pos=begin)
    name = kinematics.joint_names[leg]
    add_joint(sliding, name, 'slide', along, float(joints[leg]), drives, leg)
    inertial(sliding, rod(1e-3 * block.mass_g, radius, -half, half), zero)
    tube(sliding, -half, half, radius, GREY)
    add_rod(sliding, leg + 1, config.rod, (zero, end - begin), universal)


def _seat(kinematics: RailPlatform, universals: tuple[UniversalJoint, ...]) -> Seat:
    def seat(pose: Pose, joints: Array) -> Array:
        units = kinematics.unit_rods(pose, joints)
        legs = [
            [joints[leg], *universal.angles(units[leg])]
            for leg, universal in enumerate(universals)
        ]
        return np.concatenate([free_body(pose), np.ravel(legs)])

    return seat
