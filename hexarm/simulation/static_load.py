"""What the drives must hold against gravity, by virtual work, and where they cannot.

A drive's effort is how fast the potential energy grows with its joint: τ = −Σ m g·∂r/∂q, g the
acceleration of free fall. A rod of even density counts half at either end.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from arm_control.arm import SerialArm
from hexapod_control.linear import LinearPlatform
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.rails import RailPlatform
from hexapod_control.rotary import RotaryHexapod
from hexarm.simulation.arm_model import arm_links
from hexarm.simulation.drives import Drives
from hexarm.simulation.dynamics_config import (
    ArmDynamicsConfig,
    Dynamics,
    LinearDynamicsConfig,
    RailDynamicsConfig,
    RotaryDynamicsConfig,
)
from hexarm.simulation.platform_parts import moving_bodies
from hexarm.simulation.rigid_body import carried_bodies
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, ManipulatorError
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

PlatformDynamics = RotaryDynamicsConfig | LinearDynamicsConfig | RailDynamicsConfig


class StaticLoad(Protocol):
    """Efforts (..., n) in N·m or N that hold poses (...) with joints (..., n) at rest."""

    def __call__(self, pose: Pose, joints: Array) -> Array:
        """NoSolution at a forward singularity, where no finite effort holds the platform."""
        ...


def static_load(kinematics: Kinematics, dynamics: Dynamics) -> StaticLoad:
    """The static load of one machine; InvalidInput where kinematics and masses do not fit."""
    if isinstance(kinematics, RotaryHexapod) and isinstance(dynamics, RotaryDynamicsConfig):
        return _rods(kinematics, dynamics, 0.5e-3 * dynamics.crank.mass_g)
    if isinstance(kinematics, RailPlatform) and isinstance(dynamics, RailDynamicsConfig):
        return _rods(kinematics, dynamics, 1e-3 * dynamics.carriage.mass_g)
    if isinstance(kinematics, LinearPlatform) and isinstance(dynamics, LinearDynamicsConfig):
        return _linear(kinematics, dynamics)
    if isinstance(kinematics, SerialArm) and isinstance(dynamics, ArmDynamicsConfig):
        return _arm(kinematics, dynamics)
    raise InvalidInput(f'{type(kinematics).__name__} does not fit {type(dynamics).__name__}')


@dataclass(frozen=True, eq=False)
class _Carried:
    """Masses (k,) in kg at points (k, 3) of the platform; up is the acceleration that holds them.

    joint_mass (kg) is at each platform joint besides.
    """

    masses: Array
    points: Array
    up: Array

    @classmethod
    def by(
        cls, kinematics: ParallelPlatform, dynamics: PlatformDynamics, joint_mass: float
    ) -> '_Carried':
        joints = kinematics.geometry.platform_points
        bodies = moving_bodies(dynamics.platform, dynamics.payload, joints)
        masses = [*(body.mass for body in bodies), *np.full(len(joints), joint_mass)]
        points = np.vstack([*(body.centre for body in bodies), joints])
        return cls(np.array(masses), points, -dynamics.gravity)

    def wrench(self, pose: Pose) -> Array:
        """∂E/∂twist (..., 6)."""
        arms = self.points @ np.swapaxes(pose.rotation, -1, -2)
        # A twist (v, ω) moves the point at arm r by v + ω × r.
        turning = np.cross(arms, self.up)
        lift = np.concatenate([np.broadcast_to(self.up, turning.shape), turning], axis=-1)
        wrench: Array = np.einsum('k,...kj->...j', self.masses, lift)
        return wrench


def _in_joints(kinematics: ParallelPlatform, pose: Pose, joints: Array, wrench: Array) -> Array:
    jacobian = kinematics.jacobian(pose, joints)
    result: Array = np.einsum('...ij,...i->...j', jacobian, wrench)
    return result


def _rods(
    kinematics: ParallelPlatform,
    dynamics: RotaryDynamicsConfig | RailDynamicsConfig,
    at_base_point: float,
) -> StaticLoad:
    """Rods of one length; at_base_point (kg) is what of a crank or carriage counts there."""
    half_rod = 0.5e-3 * dynamics.rod.mass_g
    carried = _Carried.by(kinematics, dynamics, half_rod)

    def load(pose: Pose, joints: Array) -> Array:
        rise = kinematics.legs.gains(joints, np.broadcast_to(carried.up, (*joints.shape, 3)))
        own: Array = (half_rod + at_base_point) * rise
        return _in_joints(kinematics, pose, joints, carried.wrench(pose)) + own

    return load


def _linear(kinematics: LinearPlatform, dynamics: LinearDynamicsConfig) -> StaticLoad:
    carried, geometry = _Carried.by(kinematics, dynamics, 0.0), kinematics.geometry
    cylinder, piston = dynamics.cylinder, dynamics.piston
    masses = np.array([1e-3 * cylinder.mass_g, 1e-3 * piston.mass_g])
    middle = np.array([0.5e-3 * cylinder.length_mm, -0.5e-3 * piston.length_mm])

    def load(pose: Pose, joints: Array) -> Array:
        rods = kinematics.unit_rods(pose, joints)
        gaps = (
            pose.transform(kinematics.geometry.platform_points) - kinematics.geometry.base_points
        )
        lengths = np.linalg.norm(gaps, axis=-1)
        # A point s along a leg of length L whose end moves by w goes by (s/L)(w − u u·w), and a
        # piston's by u u·w more.
        share = (masses[0] * middle[0] + masses[1] * (lengths + middle[1])) / lengths
        arms = geometry.platform_points @ np.swapaxes(pose.rotation, -1, -2)
        along = rods @ carried.up
        ends = share[..., None] * carried.up + ((masses[1] - share) * along)[..., None] * rods
        wrench = carried.wrench(pose)
        wrench[..., :3] += ends.sum(axis=-2)
        wrench[..., 3:] += np.cross(arms, ends).sum(axis=-2)
        return _in_joints(kinematics, pose, joints, wrench)

    return load


def _arm(arm: SerialArm, dynamics: ArmDynamicsConfig) -> StaticLoad:
    links = arm_links(arm, dynamics)
    bodies = carried_bodies(dynamics.payload).values()
    held_points = [arm.chain.home.transform(body.centre[None])[0] for body in bodies]
    centres = np.vstack([*(link.centre for link in links), *held_points])
    masses, up = np.array([body.mass for body in (*links, *bodies)]), -dynamics.gravity
    holders = np.array([1, 2, 3, 4, 5, 6, *(6 for _ in bodies)])

    def load(pose: Pose, joints: Array) -> Array:
        moved = arm.chain.displacements(joints)
        held = moved[..., holders, :3, :]
        where = np.einsum('...kij,kj->...ki', held[..., :3], centres) + held[..., 3]
        axes = np.einsum('...nij,nj->...ni', moved[..., :-1, :3, :3], arm.chain.axes)
        points = np.einsum('...nij,nj->...ni', moved[..., :-1, :3, :3], arm.chain.points)
        points = points + moved[..., :-1, :3, 3]
        arms = where[..., None, :, :] - points[..., :, None, :]
        rise = np.cross(axes[..., :, None, :], arms) @ up
        carries = np.arange(1, 7)[:, None] <= holders
        result: Array = np.einsum('...nk,nk,k->...n', rise, carries, masses)
        return result

    return load


class Stalls(ManipulatorError, ValueError):
    """A load that the servos cannot hold; `joint` counts from 1, pose is the worst one's."""

    def __init__(self, message: str, joint: int, pose: Pose) -> None:
        super().__init__(message)
        self.joint = joint
        self.pose = pose


def check_holds(
    load: StaticLoad, drives: Drives, kinematics: Kinematics, poses: Pose, joints: Array
) -> None:
    """Raises Stalls at the worst of poses (N) where gravity needs more than a drive gives."""
    efforts = np.abs(load(poses, joints))
    shares = efforts / drives.effort
    worst, joint = np.unravel_index(np.argmax(shares), shares.shape)
    if shares[worst, joint] <= 1.0:
        return
    pose = poses[int(worst)]
    place = ', '.join(
        f'{name} {1e3 * value:.1f}' for name, value in zip('xyz', pose.position, strict=True)
    )
    turn = ', '.join(f'{value:.3f}' for value in pose.rpy)
    unit = 'N·m' if kinematics.joint_unit == 'rad' else 'N'
    raise Stalls(
        f'{kinematics.joint_names[joint]} stalls at {place} mm, rpy {turn} rad: needs '
        f'{efforts[worst, joint]:.4g} {unit}, its drive gives {drives.effort[joint]:.4g} {unit}',
        int(joint) + 1,
        pose,
    )
