"""Checks a plan tick by tick: every pose inside the limits, no joint too fast."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused, Unreachable
from manipulator.kinematics import first_jump
from manipulator.limits.constraints import Constraints
from manipulator.machine import Machine
from manipulator.motion_limits import SPEED_NAMES
from manipulator.planning.plan import MotionState, Plan
from manipulator.planning.worker import Effort
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres

TOLERANCE = 1.005
"""Limit utilisation up to which a plan is accepted."""

AT_ONCE = 256
"""Ticks solved together: bounds the memory of a long plan, and how late it is given up."""

ROUNDING = 1e-9
"""Of a tick, by which a duration that is a whole number of them may be off."""

JUMPS = 3.0
"""Degrees by which a joint that is named in a jump has moved."""

OVERLAP = 2
"""Ticks that two neighbouring batches share, so that no difference between ticks is missed."""


@dataclass(frozen=True)
class LimitUtilisation:
    """The highest utilisation of a limit: the factor by which the plan must be slowed down.

    quantity: its name, as 'speed of joint_4'; time: when, in the plan's own time.
    """

    factor: float
    quantity: str
    time: float = 0.0

    @property
    def fits(self) -> bool:
        """Whether the plan keeps all limits unchanged."""
        return self.factor <= TOLERANCE


@dataclass(frozen=True, eq=False)
class Batch:
    """Ticks of a plan one after the other: times (N,), states and joints (N, n) at them."""

    times: Array
    state: MotionState
    joints: Array


def check_plan(
    plan: Plan,
    machine: Machine,
    near: Array,
    dt: float,
    effort: Effort | None = None,
    before: Array | None = None,
) -> LimitUtilisation:
    """Simulates the plan, tick by tick, on the branch of the inverse that joints `near` are on.

    Returns the utilisation of speed and acceleration limits. A plan that begins beyond a limit may
    not go further out. Raises Refused, with the place, joint or leg, value and limit, where the
    path leaves the reach of the machine or would need another branch, and where planning would
    cost more `effort` than a plan may. before (n,): the joints one tick before the plan begins.
    """
    constraints, worst = machine.constraints, LimitUtilisation(0.0, '')
    for part in _batches(plan, machine, near, dt, effort or Effort()):
        if part.times[0] == 0.0 and np.isfinite(part.joints[0]).all():
            constraints = constraints.stretched_to(part.state.pose[0], part.joints[0])
        fault = first_fault(machine, constraints, part.state.pose, part.joints)
        if fault is not None:
            tick, reason = fault
            raise Refused(f'{plan.where(float(part.times[tick]))}: {reason}')
        found = limit_utilisation(part, machine, dt, before if part.times[0] == 0.0 else None)
        worst = max(worst, found, key=lambda one: one.factor)
    return worst


def first_fault(
    machine: Machine, constraints: Constraints, poses: Pose, joints: Array
) -> tuple[int, str] | None:
    """The first of N poses in a row that breaks a limit, and the reason; None if none does.

    joints (N, n) are those of `Kinematics.inverse_along`.
    """
    admitted, jump = constraints.admits(poses, joints), first_jump(joints)
    first = len(joints) if admitted.all() else int(np.argmin(admitted))
    if jump is not None and jump + 1 <= first:
        return jump + 1, _jump_words(machine, joints[jump], joints[jump + 1])
    if first == len(joints):
        return None
    return first, _why_not(machine, constraints, poses[first], joints[: first + 1])


def limit_utilisation(
    part: Batch, machine: Machine, dt: float, before: Array | None = None
) -> LimitUtilisation:
    """The worst ratio to a limit; accelerations count by their square root, as time does.

    before (n,): the joints one tick before, where they are known.
    """
    rows = part.joints if before is None else np.vstack([before, part.joints])
    speed = np.diff(rows, axis=0) / dt
    acceleration = np.diff(speed, axis=0) / dt
    limits, names = machine.motion.for_plans, machine.kinematics.joint_names
    readings = {
        **dict(zip(SPEED_NAMES, limits.speed_shares(part.state.twist).T, strict=True)),
        **_of_joints('speed', names, speed, limits.joint.speed),
        'linear acceleration': np.sqrt(
            _norms(part.state.acceleration[:, :3]) / limits.linear.acceleration
        ),
        'turning acceleration': np.sqrt(
            _norms(part.state.acceleration[:, 3:]) / limits.angular.acceleration
        ),
        **{
            name: np.sqrt(ratios)
            for name, ratios in _of_joints(
                'acceleration', names, acceleration, limits.joint.acceleration
            ).items()
        },
    }
    peaks = {name: float(ratios.max(initial=0.0)) for name, ratios in readings.items()}
    worst = max(peaks, key=lambda name: peaks[name])
    tick = min(int(np.argmax(readings[worst])), len(part.times) - 1)
    return LimitUtilisation(peaks[worst], worst, float(part.times[tick]))


def _batches(
    plan: Plan, machine: Machine, near: Array, dt: float, effort: Effort
) -> Iterator[Batch]:
    """The plan's ticks up to its last moment, AT_ONCE at a time; joints go on from `near`."""
    count = int(np.ceil(plan.checked_duration / dt - ROUNDING)) + 1
    begin, joints = 0, near[None]
    while True:
        end = min(begin + AT_ONCE, count)
        effort.spend(end - begin)
        times: Array = dt * np.arange(begin, end, dtype=np.float64)
        state = plan.at(times)
        own = plan.joints_at(times)
        joints = machine.kinematics.inverse_along(state.pose, joints[0]) if own is None else own
        yield Batch(times, state, joints)
        if end == count:
            return
        begin = end - OVERLAP
        joints = joints[-OVERLAP:]


def _of_joints(what: str, names: Sequence[str], rates: Array, limit: Array) -> dict[str, Array]:
    ratios = np.abs(rates) / limit
    return {f'{what} of {name}': ratios[:, k] for k, name in enumerate(names)}


def _jump_words(machine: Machine, before: Array, after: Array) -> str:
    kinematics, change = machine.kinematics, np.degrees(np.abs(after - before))
    named = zip(kinematics.joint_names, change, strict=True)
    moved = [f'{name} by {degrees:.0f}°' for name, degrees in named if degrees > JUMPS]
    return f'the joints would have to jump, {", ".join(moved)}: the posture there is singular'


def _why_not(machine: Machine, constraints: Constraints, pose: Pose, joints: Array) -> str:
    """What keeps the machine from a pose, in words; joints (k, n) are those up to it."""
    try:
        with hint_at_metres(machine.kinematics, pose):
            if not np.isfinite(joints[-1]).all():
                near = joints[-2] if len(joints) > 1 and np.isfinite(joints[-2]).all() else None
                machine.kinematics.inverse(pose, near)
                return 'the inverse kinematics ends there: the posture is singular'
            constraints.check(pose, joints[-1])
    except Unreachable as error:
        return str(error)
    return 'out of reach'


def _norms(vectors: Array) -> Array:
    lengths: Array = np.sqrt(np.einsum('ij,ij->i', vectors, vectors))
    return lengths
