"""Rest-to-rest moves in joint space: all joints in proportion, as quickly as limits allow.

They lead from one branch of the inverse kinematics to another, unwind joints, and pass singular
postures, where no line move leads. The tool's path is what the joints make of it.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution, Refused
from manipulator.kinematics import POSE_NUMBERS
from manipulator.machine import Machine
from manipulator.motion_limits import MotionLimits
from manipulator.planning.joint_curve import JointCurvePlan
from manipulator.planning.point_to_point import Profile, profile_within
from manipulator.pose import Pose

KNOTS = 64
"""Poses along the move that are known beforehand: forward kinematics begin at the nearest."""

TINY = 1e-9
"""rad or m that count as no motion."""


@dataclass(frozen=True, eq=False)
class ProportionalJoints:
    """q(s) = (1 − s)·begin + s·end, s from 0 to 1 along the profile; begin, end (n,), rad or m."""

    begin: Array
    end: Array
    profile: Profile

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return self.profile.duration

    def at(self, times: Array | float) -> tuple[Array, Array, Array]:
        """See `CoordinateCurve`."""
        s, rate, pull = self.profile.at(times)
        change = self.end - self.begin
        return between(self.begin, self.end, s), rate[..., None] * change, pull[..., None] * change


@dataclass(frozen=True, eq=False)
class JointMove(JointCurvePlan):
    """A plan of such joints; its knots are the poses (KNOTS + 1,) at equal steps of s."""

    curve: ProportionalJoints

    def where(self, time: float) -> str:
        """See `Plan`."""
        return f'at {100 * self._share(time):.0f} % of the joint move'

    def _knot(self, time: float) -> int:
        return round(self._share(time) * KNOTS)

    def _share(self, time: float) -> float:
        return float(self.curve.profile.at(time)[0])


def between(begin: Array, end: Array, s: Array) -> Array:
    """Joints (..., n) at each s (...): exactly the ends at 0 and 1."""
    share = s[..., None]
    joints: Array = (1.0 - share) * begin + share * end
    return joints


def plan_joint_move(
    machine: Machine, start: Pose, begin: Array, goal: Array, slowdown: float = 1.0
) -> JointMove:
    """The quickest move from joints `begin`, at pose `start`, to joints `goal` (n,).

    slowdown k ≥ 1 makes it take k times as long. Raises Refused where the joints between fix no
    pose, as beyond a platform's forward singularities, and for a machine with more joints than a
    pose has numbers: setpoints are poses, and other joints than these would follow from them.
    """
    refuse_rule(len(begin))
    rows = between(begin, goal, np.linspace(0.0, 1.0, KNOTS + 1))
    try:
        knots = machine.kinematics.forward_along(rows, start)
    except NoSolution as error:
        raise Refused(f'on the joint move: {error}') from error
    steps = knots[:-1].twist_to(knots[1:]) * KNOTS
    profile = profile_within(_bounds(machine.motion.for_plans, goal - begin, steps), slowdown)
    curve = ProportionalJoints(frozen(begin), frozen(goal), profile)
    return JointMove(machine.kinematics, curve, knots)


def refuse_rule(joints: int) -> None:
    """Refused for a machine with so many joints that a rule chooses them for each pose."""
    if joints > POSE_NUMBERS:
        raise Refused(
            f'{joints} joints cannot be commanded one by one: a rule gives them for each pose; '
            'command a pose, along a line'
        )


def _bounds(limits: MotionLimits, change: Array, steps: Array) -> tuple[float, float, float]:
    """The most that ṡ, s̈ and s⃛ may be: by each joint, and by the tool's or platform's speed."""
    longest = max(float(np.linalg.norm(steps[:, :3], axis=1).max()), TINY)
    widest = max(float(np.linalg.norm(steps[:, 3:], axis=1).max()), TINY)
    moved = np.maximum(np.abs(change), TINY)
    speed = min(
        float((limits.joint.speed / moved).min()),
        1.0 / max(float(limits.speed_shares(steps).max()), TINY),
    )
    acceleration = min(
        float((limits.joint.acceleration / moved).min()),
        limits.linear.acceleration / longest,
        limits.angular.acceleration / widest,
    )
    jerk = min(limits.linear.jerk / longest, limits.angular.jerk / widest)
    return speed, acceleration, jerk
