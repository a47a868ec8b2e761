"""Jogging any machine by its inverse kinematics, with the braking path checked at every tick.

A platform's limits (reach, rod ends, singularity margin) cannot be turned into joint ranges. So
each tick drives only a twist from which braking straight ahead keeps all of them: braking
remains available when no other twist is allowed. It ends at the edge, where everything that
led there is open for the way back.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from manipulator.arrays import Array, Mask, frozen
from manipulator.limits.constraints import Constraints
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion, ticks_for, towards

if TYPE_CHECKING:
    from manipulator.machine import Machine

SCALES = 0.75 ** np.arange(17)
"""Parts of the target twist that are tried, from all of it down to 1 %."""
ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class PlatformJogger:
    """`Jogger` of a machine whose joints follow from its pose."""

    machine: 'Machine'

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """See `Jogger`; the largest of SCALES that can be driven and braked, else it brakes."""
        constraints = self.machine.constraints
        target = SCALES[:, None] * twist
        aims = towards(motion.twist, target, self.machine.motion, dt)
        held_by = ''
        for first, last in ((0, 1), (1, len(SCALES))):
            paths = self._paths(motion, aims[first:last], dt)
            inside = constraints.admits(paths.poses, paths.joints)
            if first == 0 and not paths.fit(inside)[0]:
                # Stretched limits let more through: they matter where a limit is broken.
                constraints = constraints.stretched_to(motion.pose, motion.joints)
                if constraints is not self.machine.constraints:
                    inside = constraints.admits(paths.poses, paths.joints)
            is_fit = paths.fit(inside)
            if is_fit.any():
                chosen = int(np.argmax(is_fit))
                scale = float(SCALES[first + chosen])
                return self._moved(motion, aims[first + chosen], dt, scale, held_by)
            held_by = held_by or paths.obstacle(self.machine, constraints, inside[0])
        ticks = _braking_ticks(motion.twist, self.machine, dt)
        return self._moved(motion, motion.twist * (1.0 - 1.0 / ticks), dt, 0.0, held_by)

    def _moved(
        self, motion: JogMotion, twist: Array, dt: float, scale: float, held_by: str
    ) -> JogMotion:
        if not twist.any():
            still = JogMotion.at_rest(motion.pose, motion.joints)
            return replace(still, scale=scale, held_by=held_by)
        pose = motion.pose.moved(twist * dt)
        joints = self.machine.kinematics.inverse(pose, motion.joints)
        rates = frozen((joints - motion.joints) / dt)
        return JogMotion(pose, frozen(joints), frozen(twist), rates, scale, held_by)

    def _paths(self, motion: JogMotion, twists: Array, dt: float) -> '_Ways':
        """One tick at each of the twists (k, 6), then braking straight ahead to rest."""
        ticks = _braking_ticks(twists, self.machine, dt)
        steps = np.arange(int(ticks.max()) + 1)
        parts = np.maximum(1.0 - steps / ticks[:, None], 0.0)
        gone = np.cumsum(parts, axis=1)[..., None] * twists[:, None] * dt
        poses = motion.pose.moved(gone)
        joints = self.machine.kinematics.inverse_or_nan(poses, motion.joints)
        return _Ways(poses, joints, *self._excess(motion, joints, dt))

    def _excess(self, motion: JogMotion, joints: Array, dt: float) -> tuple[Array, Array]:
        """Speeds and accelerations of joints (k, ticks, n) from now on, over their limits."""
        k, ticks, n = joints.shape
        rates = np.empty((k, ticks + 1, n))  # with the present ones before
        rates[:, 0] = motion.rates
        np.subtract(joints[:, 0], motion.joints, out=rates[:, 1])
        np.subtract(joints[:, 1:], joints[:, :-1], out=rates[:, 2:])
        rates[:, 1:] /= dt
        changes = (rates[:, 1:] - rates[:, :-1]) / dt
        limits = self.machine.motion.joint
        return np.abs(rates[:, 1:]) / limits.speed, np.abs(changes) / limits.acceleration


@dataclass(frozen=True, eq=False)
class _Ways:
    """Poses (k, ticks) of k braking paths, and their joints (k, ticks, n).

    speeds and accelerations are those of the joints, as parts of what is allowed.
    """

    poses: Pose
    joints: Array
    speeds: Array
    accelerations: Array

    def fit(self, inside: Mask) -> Mask:
        """Which of the k paths keep the joints' limits and the constraints (`inside`)."""
        slow_enough = (self.speeds <= 1.0).all(axis=-1) & (self.accelerations <= 1.0).all(axis=-1)
        result: Mask = np.asarray((inside & slow_enough).all(axis=-1), dtype=np.bool_)
        return result

    def obstacle(self, machine: 'Machine', constraints: Constraints, inside: Mask) -> str:
        """What limits the first of the paths, in words; inside: which ticks of it are."""
        if not inside.all():
            first = int(np.argmin(inside))
            found = constraints.violations(self.poses[0][first], self.joints[0, first])[0]
            return f'{found.quantity} of {found.owner}' if found.owner else found.quantity
        names = machine.kinematics.joint_names
        for what, excess in (('speed', self.speeds), ('acceleration', self.accelerations)):
            worst = excess[0].max(axis=0)
            if worst.max() > 1.0:
                return f'{what} of {names[int(np.argmax(worst))]}'
        return ''


def _braking_ticks(twist: Array, machine: 'Machine', dt: float) -> Array:
    """In how many ticks (...) a twist (..., 6) comes to rest, at least 1.

    One tick of braking from n takes to exactly n − 1, so that a path once checked stays the same.
    """
    result: Array = np.ceil(np.maximum(ticks_for(twist, machine.motion, dt) - ROUNDING, 1.0))
    return result
