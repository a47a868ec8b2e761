"""What a motion of a crank platform costs in torque on its cranks, without simulating it.

By virtual work on the platform, the rods and the cranks. A rod of even density between moving
ends a and b has the consistent mass of a bar: the force that moves its end a is
m/6 (2ä + b̈), less half its weight. docs/physics.md, section 3.
"""

from dataclasses import dataclass, field

import numpy as np

from hexapod_control.rotary import RotaryHexapod
from hexarm.simulation.dynamics_config import RotaryDynamicsConfig
from hexarm.simulation.platform_parts import moving_bodies
from hexarm.simulation.rigid_body import RigidBody
from manipulator.arrays import Array
from manipulator.planning.plan import MotionState

NEAR = 1e-5
"""Seconds to either side over which the crank rates' change is taken."""


@dataclass(frozen=True, eq=False)
class CrankMotion:
    """Angles, rates and accelerations (..., 6) of the cranks, in rad and s."""

    angles: Array
    rates: Array
    accelerations: Array


@dataclass(frozen=True, eq=False)
class InverseDynamics:
    """Torques of one machine's cranks; the body moving is the platform with its payload."""

    kinematics: RotaryHexapod
    dynamics: RotaryDynamicsConfig
    moving: RigidBody = field(init=False)

    def __post_init__(self) -> None:
        """Joins the platform and its payload."""
        config, points = self.dynamics, self.kinematics.geometry.platform_points
        first, *rest = moving_bodies(config.platform, config.payload, points)
        for body in rest:
            first = first.with_body(body)
        object.__setattr__(self, 'moving', first)

    def cranks(self, motion: MotionState) -> CrankMotion:
        """How the cranks move; Unreachable or NoSolution where they cannot."""
        angles = self.kinematics.inverse(motion.pose)
        ahead, behind = (self._rates(_moved(motion, t)) for t in (NEAR, -NEAR))
        return CrankMotion(angles, self._rates(motion), (ahead - behind) / (2 * NEAR))

    def torques(self, motion: MotionState, cranks: CrankMotion) -> Array:
        """Torques (..., 6) on the crank shafts, N·m; the servos' rotors are not in them."""
        geometry, config = self.kinematics.geometry, self.dynamics
        rod, crank = 1e-3 * config.rod.mass_g, 1e-3 * config.crank.mass_g
        lengths = geometry.crank_lengths
        tangent, inward = _tip_directions(self.kinematics, cranks.angles)
        lever = lengths[:, None] * tangent
        tip = (
            cranks.accelerations[..., None] * lever
            + cranks.rates[..., None] ** 2 * lengths[:, None] * inward
        )
        arms = geometry.platform_points @ np.swapaxes(motion.pose.rotation, -1, -2)
        end = _acceleration_at(motion, arms)
        weight = -0.5 * rod * config.gravity
        at_end = rod / 6 * (2 * end + tip) + weight
        at_tip = rod / 6 * (2 * tip + end) + weight - 0.5 * crank * config.gravity
        wrench = self._moving_wrench(motion)
        wrench[..., :3] += at_end.sum(axis=-2)
        wrench[..., 3:] += np.cross(arms, at_end).sum(axis=-2)
        jacobian = self.kinematics.jacobian(motion.pose, cranks.angles)
        own = crank * lengths**2 / 3 * cranks.accelerations + (at_tip * lever).sum(axis=-1)
        result: Array = np.einsum('...ij,...i->...j', jacobian, wrench) + own
        return result

    def _rates(self, motion: MotionState) -> Array:
        angles = self.kinematics.inverse(motion.pose)
        by_twist = self.kinematics.joint_rates(motion.pose, angles)
        rates: Array = np.einsum('...ij,...j->...i', by_twist, motion.twist)
        return rates

    def _moving_wrench(self, motion: MotionState) -> Array:
        """Force and moment about the platform's origin that move platform and payload."""
        body, rotation = self.moving, motion.pose.rotation
        arm = np.einsum('...ij,j->...i', rotation, body.centre)
        inertia = rotation @ body.inertia @ np.swapaxes(rotation, -1, -2)
        centre = _acceleration_at(motion, arm[..., None, :])[..., 0, :]
        force = body.mass * (centre - self.dynamics.gravity)
        turning, omega = motion.acceleration[..., 3:], motion.twist[..., 3:]
        spin = np.einsum('...ij,...j->...i', inertia, omega)
        moment = np.einsum('...ij,...j->...i', inertia, turning) + np.cross(omega, spin)
        return np.concatenate([force, moment + np.cross(arm, force)], axis=-1)


def _tip_directions(kinematics: RotaryHexapod, angles: Array) -> tuple[Array, Array]:
    """Where each tip goes as its crank turns on, and where it bends to: unit (..., 6, 3)."""
    g = kinematics.geometry
    cosine, sine = np.cos(angles)[..., None], np.sin(angles)[..., None]
    return cosine * g.ups - sine * g.tangents, -(cosine * g.tangents + sine * g.ups)


def _acceleration_at(motion: MotionState, arms: Array) -> Array:
    """Of points (..., k, 3) from the platform's origin, base axes."""
    omega, turning = motion.twist[..., None, 3:], motion.acceleration[..., None, 3:]
    linear = motion.acceleration[..., None, :3]
    result: Array = linear + np.cross(turning, arms) + np.cross(omega, np.cross(omega, arms))
    return result


def _moved(motion: MotionState, seconds: float) -> MotionState:
    twist = motion.twist + seconds * motion.acceleration
    mean = motion.twist + seconds / 2 * motion.acceleration
    return MotionState(motion.pose.moved(seconds * mean), twist, motion.acceleration)
