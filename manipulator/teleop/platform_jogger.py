"""Jogging any machine by its inverse kinematics, with the braking path checked at every tick.

A platform's limits (reach, rod ends, singularity margin) cannot be turned into joint ranges. So
each tick drives only a twist from which braking straight ahead keeps all of them: braking
remains available when no other twist is allowed. It ends at the edge, where everything that
led there is open for the way back.
"""

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from manipulator.arrays import Array, frozen, stretched
from manipulator.errors import InvalidInput
from manipulator.limits.constraints import Constraints
from manipulator.limits.limit import BrakingPaths
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.jogger import JogMotion, ticks_for, towards

if TYPE_CHECKING:
    from manipulator.machine import Machine

SCALES = 0.75 ** np.arange(17)
"""Parts of the target twist that are tried, from all of it down to 1 %."""
ROUNDING = 1e-9
A_LIMIT, A_SPEED = 1, 2
"""What limits a braking path; else it is an acceleration: `obstacle` of kernel/braking.h."""


@dataclass(frozen=True, eq=False)
class PlatformJogger:
    """`Jogger` of a machine whose joints follow from its pose; limits are those of one platform.

    bounds (15,) are `jog_bounds` of kernel/braking.h, the tick left out.
    """

    machine: 'Machine'
    bounds: Array = field(init=False)

    def __post_init__(self) -> None:
        """Lays out what bounds the motion; InvalidInput where limits are not of one group."""
        if not self.machine.constraints.is_one_group:
            raise InvalidInput('a platform is jogged within the limits of one platform')
        motion, count = self.machine.motion, len(self.machine.kinematics.joint_names)
        joints = (stretched(a, (count,)) for a in (motion.joint.speed, motion.joint.acceleration))
        ends = [0.0, motion.linear.acceleration, motion.angular.acceleration]
        object.__setattr__(self, 'bounds', frozen(np.concatenate([ends, *joints])))

    def step(self, motion: JogMotion, twist: Array, dt: float) -> JogMotion:
        """See `Jogger`; the largest of SCALES that can be driven and braked, else it brakes."""
        constraints, limits, held_by = self.machine.constraints, self.machine.motion, ''
        for scales in (SCALES[:1], SCALES[1:]):
            aims = np.array([towards(motion.twist, s * twist, limits, dt) for s in scales])
            free, paths = self._paths(constraints, motion, aims, dt)
            if free == len(scales) == 1:
                # Stretched limits let more through: they matter where a limit is broken.
                wider = constraints.stretched_to(motion.pose, motion.joints)
                if wider is not constraints:
                    constraints = wider
                    free, paths = self._paths(constraints, motion, aims, dt)
            if free < len(scales):
                return self._moved(motion, aims[free], dt, float(scales[free]), held_by)
            held_by = held_by or self._obstacle(constraints, paths[0])
        ticks = _braking_ticks(motion.twist, limits, dt)
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

    def _paths(
        self, constraints: Constraints, motion: JogMotion, twists: Array, dt: float
    ) -> tuple[int, Array]:
        """One tick at each of the twists (k, 6), then braking straight ahead to rest.

        The first without an obstacle, k for none, and the obstacles of those before.
        """
        bounds = self.bounds.copy()
        bounds[0] = dt
        group, ranges = constraints.checks[0]
        paths = BrakingPaths(bounds, motion.pose, motion.joints, motion.rates, twists)
        return group.first_free_path(ranges, paths)

    def _obstacle(self, constraints: Constraints, path: Array) -> str:
        """What limits a path, in words; path is a `braking_path` of kernel/braking.h."""
        kind, joint = int(path[0]), int(path[1])
        if kind == A_LIMIT:
            pose = Pose(path[2:5], path[5:14].reshape(3, 3))
            found = constraints.violations(pose, path[14:])
            parts = (found[0].quantity, found[0].owner) if found else ('', '')
            return ' of '.join(filter(None, parts))
        what = 'speed' if kind == A_SPEED else 'acceleration'
        return f'{what} of {self.machine.kinematics.joint_names[joint]}'


def _braking_ticks(twist: Array, limits: MotionLimits, dt: float) -> int:
    """In how many ticks a twist (6,) comes to rest, at least 1.

    One tick of braking from n takes to exactly n − 1, so that a path once checked stays the same.
    """
    return max(math.ceil(ticks_for(twist, limits, dt) - ROUNDING), 1)
