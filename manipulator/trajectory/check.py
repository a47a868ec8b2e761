"""Whether a machine can drive a plan: every tick inside the limits, no joint too fast."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from manipulator.arrays import Array
from manipulator.continuity import joints_along
from manipulator.errors import Refused, Unreachable
from manipulator.machine import Machine
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.trajectory.plan import MotionState, Plan
from manipulator.unit_hints import hint_at_metres

TOLERANCE = 1.005


@dataclass(frozen=True)
class Demand:
    """What a plan asks for most, as the factor by which it would have to be slowed down."""

    slowness: float
    quantity: str

    @property
    def fits(self) -> bool:
        """Whether the plan keeps all limits as it is."""
        return self.slowness <= TOLERANCE


def check_plan(plan: Plan, machine: Machine, near: Array, dt: float) -> Demand:
    """Drives the plan in thought, tick by tick, from joints `near`.

    Returns what it demands of speed and acceleration. A plan that begins beyond a limit may not
    go further out. Raises Refused, with time, leg, value and
    limit, where the way leaves the reach of the machine.
    """
    times = np.arange(0.0, plan.checked_duration + dt, dt)
    state = plan.at(times)
    joints = joints_along(machine, state.pose, near)
    constraints = machine.constraints
    admitted = constraints.admits(state.pose, joints)
    if not admitted[0] and np.isfinite(joints[0]).all():
        constraints = constraints.stretched_to(state.pose[0], joints[0])
        admitted = constraints.admits(state.pose, joints)
    if not admitted.all():
        first = int(np.argmin(admitted))
        reason = why_not(machine, state.pose[first], near if first == 0 else joints[first - 1])
        raise Refused(f'after {times[first]:.2f} s of the way: {reason}')
    return demand(state, joints, machine.motion, dt)


def why_not(machine: Machine, pose: Pose, near: Array) -> str:
    """What keeps the machine from a pose, in words."""
    try:
        with hint_at_metres(machine.kinematics, pose):
            machine.constraints.check(pose, machine.kinematics.inverse(pose, near))
    except Unreachable as error:
        return str(error)
    return 'out of reach'


def demand(state: MotionState, joints: Array, limits: MotionLimits, dt: float) -> Demand:
    """The worst ratio to a limit; accelerations count by their square root, as time does."""
    speed = np.diff(joints, axis=0) / dt
    acceleration = np.diff(speed, axis=0) / dt
    limits = limits.for_plans
    readings = {
        'platform speed': _norm(state.twist[:, :3]) / limits.linear.speed,
        'turning speed': _norm(state.twist[:, 3:]) / limits.angular.speed,
        'joint speed': _largest(speed / limits.joint.speed),
        'platform acceleration': sqrt(
            _norm(state.acceleration[:, :3]) / limits.linear.acceleration
        ),
        'turning acceleration': sqrt(
            _norm(state.acceleration[:, 3:]) / limits.angular.acceleration
        ),
        'joint acceleration': sqrt(_largest(acceleration / limits.joint.acceleration)),
    }
    worst = max(readings, key=lambda name: readings[name])
    return Demand(readings[worst], worst)


def _norm(vectors: Array) -> float:
    return float(np.sqrt(np.einsum('ij,ij->i', vectors, vectors).max()))


def _largest(values: Array) -> float:
    return float(np.abs(values).max()) if values.size else 0.0
