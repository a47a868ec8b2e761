"""Jogging joint by joint: rates of the joints, with the braking path checked at every tick.

As platform_jogger.py, in joint space: each tick drives only rates from which braking keeps every
limit on joints and poses. Rates are scaled as a whole. So a jog stops smoothly at the edge of a
range or of a platform's reach, and the opposite one leads back.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution, Unreachable
from manipulator.limits.constraints import Constraints
from manipulator.motion_limits import SPEED_NAMES
from manipulator.pose import Pose

if TYPE_CHECKING:
    from manipulator.machine import Machine

SCALES = (1.0, 0.5, 0.2, 0.05, 0.01)
"""Parts of the requested rates that are tried."""

MOST_BRAKING = 200
"""Ticks of a braking path that are looked at."""

ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class JointMotion:
    """Where a jog has come to: joints and rates (n,), the pose and twist (6,) that they make.

    ticks: those that the checked braking path takes from here. scale, held_by: see `JogMotion`.
    """

    pose: Pose
    joints: Array
    rates: Array
    twist: Array
    ticks: int = 0
    scale: float = 1.0
    held_by: str = ''

    @classmethod
    def at_rest(
        cls, pose: Pose, joints: Array, scale: float = 1.0, held_by: str = ''
    ) -> 'JointMotion':
        """Standing still."""
        still = frozen(np.zeros(len(joints)))
        return cls(pose, joints, still, frozen(np.zeros(6)), 0, scale, held_by)

    @property
    def is_at_rest(self) -> bool:
        """Whether nothing moves."""
        return not self.rates.any()


@dataclass(frozen=True, eq=False)
class JointJogger:
    """Follows joint rates within the limits of a machine; without state of its own."""

    machine: 'Machine'

    def step(self, motion: JointMotion, target: Array, dt: float) -> JointMotion:
        """The motion dt seconds later, towards rates (n,) in rad/s or m/s; zeros brake.

        From every motion that it returns, braking by the same part of the rates at each of its
        `ticks` keeps the limits; where no other rates do, that is what happens.
        """
        constraints = self.machine.constraints.stretched_to(motion.pose, motion.joints)
        jacobian = self.machine.kinematics.jacobian(motion.pose, motion.joints)
        most, held_by = self._within_speed(jacobian, target)
        tried: Array | None = None
        for scale in SCALES if target.any() else SCALES[:1]:
            rates = self._towards(jacobian, motion.rates, scale * most * target, dt)
            if tried is not None and np.abs(rates - tried).max() < ROUNDING:
                continue
            tried = rates
            found, obstacle = self._driven(constraints, jacobian, motion, rates, dt)
            if found is not None:
                return replace(found, scale=scale * most, held_by=held_by)
            held_by = obstacle
        return self._braked(motion, held_by, dt)

    def _within_speed(self, jacobian: Array, target: Array) -> tuple[float, str]:
        """The part of the rates that keeps every speed limit, and what sets it."""
        limits, twist = self.machine.motion, jacobian @ target
        shares = np.abs(target) / limits.joint.speed
        worst = int(np.argmax(shares))
        name = self.machine.kinematics.joint_names[worst]
        readings = {
            f'speed of {name}': float(shares[worst]),
            **dict(zip(SPEED_NAMES, limits.speed_shares(twist).tolist(), strict=True)),
        }
        first = max(readings, key=lambda one: readings[one])
        return (1.0, '') if readings[first] <= 1.0 else (1.0 / readings[first], first)

    def _ticks(self, jacobian: Array, change: Array, dt: float) -> float:
        """How many ticks a change of the rates (n,) takes at full acceleration."""
        limits, twist = self.machine.motion, jacobian @ change
        return max(
            float((np.abs(change) / limits.joint.acceleration).max()),
            float(np.linalg.norm(twist[:3])) / limits.linear.acceleration,
            float(np.linalg.norm(twist[3:])) / limits.angular.acceleration,
        ) / dt  # fmt: skip

    def _towards(self, jacobian: Array, rates: Array, target: Array, dt: float) -> Array:
        change = target - rates
        ticks = self._ticks(jacobian, change, dt)
        return target if ticks <= 1.0 else rates + change / ticks

    def _driven(
        self,
        constraints: Constraints,
        jacobian: Array,
        motion: JointMotion,
        rates: Array,
        dt: float,
    ) -> tuple[JointMotion | None, str]:
        """One tick at these rates, if braking from there keeps the limits; else what does not."""
        if not rates.any():
            return JointMotion.at_rest(motion.pose, motion.joints), ''
        kinematics = self.machine.kinematics
        ticks = int(np.ceil(max(self._ticks(jacobian, rates, dt) - ROUNDING, 1.0)))
        shares = 1.0 - np.arange(min(ticks, MOST_BRAKING)) / ticks
        joints = motion.joints + dt * np.cumsum(shares)[:, None] * rates
        try:
            poses = kinematics.forward_along(joints, motion.pose)
        except (NoSolution, Unreachable):
            return None, 'these joints fix no pose'
        broken = np.flatnonzero(~constraints.admits(poses, joints))
        if broken.size:
            found = constraints.violations(poses[int(broken[0])], joints[broken[0]])
            return None, ' of '.join(filter(None, (found[0].quantity, found[0].owner)))
        twist = frozen(jacobian @ rates)
        return JointMotion(poses[0], frozen(joints[0]), frozen(rates), twist, ticks), ''

    def _braked(self, motion: JointMotion, held_by: str, dt: float) -> JointMotion:
        """One tick of the braking path that was checked when these rates were chosen."""
        left = max(motion.ticks - 1, 0)
        if left == 0:
            return JointMotion.at_rest(motion.pose, motion.joints, 0.0, held_by)
        share = left / motion.ticks
        rates = motion.rates * share
        joints = motion.joints + dt * rates
        pose = self.machine.kinematics.forward_along(joints[None], motion.pose)[0]
        twist = frozen(motion.twist * share)
        return JointMotion(pose, frozen(joints), frozen(rates), twist, left, 0.0, held_by)
