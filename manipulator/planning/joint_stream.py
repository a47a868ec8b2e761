"""Moves of joints that begin in motion: along a stream of goals of joints, or to another goal.

As with poses, a stream is joined by polynomials; then all joints go to rest at once, as quickly as
limits allow.
"""

from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import NoSolution, Refused
from manipulator.machine import Machine
from manipulator.planning.flowing import Attempt, flowing_to
from manipulator.planning.goal import Flow
from manipulator.planning.joint_curve import JointCurvePlan
from manipulator.planning.plan import CoordinateCurve, Ends
from manipulator.planning.point_to_point import quickest
from manipulator.pose import Pose

KNOTS = 16
"""Poses along the move that are known beforehand: forward kinematics begin at the nearest."""

TINY = 1e-9
"""m or rad per rad or m of a joint that count as no motion."""


@dataclass(frozen=True, eq=False)
class JointMoveInMotion(JointCurvePlan):
    """A plan of joints that begins in motion."""

    def where(self, time: float) -> str:
        """See `Plan`."""
        share = min(time / max(self.duration, 1e-9), 1.0)
        return f'at {100 * share:.0f} % of the time of the joint move'


@dataclass(frozen=True, eq=False)
class MovingJoints:
    """Joints (n,) with two derivatives, in motion or at rest, and the pose that they make."""

    pose: Pose
    joints: Ends


def plan_joint_move_in_motion(
    machine: Machine, start: MovingJoints, goal: Array, slowdown: float
) -> JointMoveInMotion:
    """To rest at joints `goal` (n,); slowdown and errors: see `quickest`."""
    return _plan(machine, start, quickest(start.joints, goal, _bounds(machine, start), slowdown))


def plan_joint_stream(
    machine: Machine, start: MovingJoints, goal: Array, flow: Flow, time: float, how: Attempt
) -> JointMoveInMotion | None:
    """At that time, to joints `goal` (n,) with their flow; errors: see `flowing_to`."""
    curve = flowing_to(start.joints, goal, flow, time, _bounds(machine, start), how)
    return None if curve is None else _plan(machine, start, curve)


def _plan(machine: Machine, start: MovingJoints, curve: CoordinateCurve) -> JointMoveInMotion:
    rows = curve.at(np.linspace(0.0, curve.duration, KNOTS))[0]
    try:
        knots = machine.kinematics.forward_along(rows, start.pose)
    except NoSolution as error:
        raise Refused(f'on the joint move: {error}') from error
    return JointMoveInMotion(machine.kinematics, curve, knots)


def _bounds(machine: Machine, start: MovingJoints) -> Ends:
    """Speed, acceleration and jerk of each joint (n,): if it alone moved the platform or tool.

    Raises Refused in a posture where joint rates fix no twist.
    """
    try:
        jacobian = machine.kinematics.jacobian(start.pose, start.joints[0])
    except NoSolution as error:
        raise Refused(f'on the joint move: {error}') from error
    shift = np.maximum(np.linalg.norm(jacobian[:3], axis=0), TINY)
    turn = np.maximum(np.linalg.norm(jacobian[3:], axis=0), TINY)
    limits = machine.motion.for_plans
    linear, angular, joint = limits.linear, limits.angular, limits.joint
    own = np.minimum(linear.speed / shift, angular.speed / turn)
    pull = np.minimum(linear.acceleration / shift, angular.acceleration / turn)
    jerk: Array = np.minimum(linear.jerk / shift, angular.jerk / turn)
    return np.minimum(own, joint.speed), np.minimum(pull, joint.acceleration), jerk
