"""A joint trajectory as a plan: a curve of the joints that is checked before it begins.

It starts from rest where the machine is, at its first point or before it, and ends at rest.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.errors import NoSolution, Refused
from manipulator.formatting import plain
from manipulator.machine import Machine
from manipulator.planning.check import check_plan
from manipulator.planning.joint_curve import (
    Curve,
    JointCurvePlan,
    narrowest,
    rounded_lines,
    splines,
    widest,
)
from manipulator.planning.joint_move import refuse_rule
from manipulator.planning.joint_points import AT_REST, JointPoints
from manipulator.planning.path_timing import MOST_TICKS
from manipulator.planning.worker import Effort
from manipulator.pose import Pose

KNOT_STEP, FEWEST_KNOTS, MOST_KNOTS = 0.05, 64, 20_000
"""Seconds between poses that are known beforehand, and how many: solutions begin there."""

ROUNDINGS = 8
"""Attempts to round the corners of lines within the limits."""

NARROWEST = 2.0
"""Ticks of half a corner, where no joint's acceleration asks for more."""


@dataclass(frozen=True, eq=False)
class JointTrajectory(JointCurvePlan):
    """ends (m,): when each point is reached; numbers (m,): as their sender counts them."""

    ends: Array
    numbers: tuple[int, ...]

    def percent(self, time: float) -> int:
        """How much of its time is over at the last half second before `time`."""
        return int(100 * (time // 0.5 * 0.5) / max(self.duration, 0.5))

    def where(self, time: float) -> str:
        """See `Plan`: by the time, and the point that comes next."""
        following = min(int(np.searchsorted(self.ends, time)), len(self.ends) - 1)
        return f'{time:.2f} s after the start, before point {self.numbers[following]}'


@dataclass(frozen=True, eq=False)
class JointStart:
    """Where a trajectory begins, at rest: a pose, its joints (n,); dt is a tick (s).

    tolerance (n,): how far a trajectory's first point may be from these joints.
    """

    pose: Pose
    joints: Array
    dt: float
    tolerance: Array


def plan_joint_trajectory(
    machine: Machine, start: JointStart, points: JointPoints, effort: Effort
) -> JointTrajectory:
    """The plan through the points, whose times are seconds from its beginning.

    A point at the time 0 is where the machine stands; else the machine goes to the first one by
    its time. Raises Refused, with the point, joint, value and limit, where a limit would be
    broken, and where the machine stands elsewhere: times are never changed.
    """
    refuse_rule(len(start.joints))
    _check_begin(machine, start, points)
    if points.times[-1] > MOST_TICKS * start.dt:
        most = MOST_TICKS * start.dt
        raise Refused(f'the trajectory would take {points.times[-1]:.0f} s, at most {most:.0f} s')
    for curve, ends in _curves(machine, start, points):
        plan = _plan(machine, start, curve, ends, points.numbers, effort)
        try:
            peak = check_plan(plan, machine, start.joints, start.dt, effort)
        except NoSolution as error:
            raise Refused(f'on the trajectory: {error}') from error
        if peak.fits:
            return plan
    raise Refused(
        f'{plan.where(peak.time)}: {peak.quantity} would be too high: '
        f'give the trajectory {peak.factor:.3g} times as much time there'
    )


def _check_begin(machine: Machine, start: JointStart, points: JointPoints) -> None:
    """Refused where a point at the time 0 is not where the machine stands, at rest."""
    if points.times[0] > 0.0:
        return
    kinematics = machine.kinematics
    away = np.abs(points.positions[0] - start.joints) - start.tolerance
    k = int(np.argmax(away))
    if away[k] > 0.0:
        raise Refused(
            f'{kinematics.joint_names[k]} is at {plain(start.joints[k])} {kinematics.joint_unit}, '
            f'the trajectory begins at {plain(points.positions[0, k])} {kinematics.joint_unit}: '
            f'at most {start.tolerance[k]:.2g} {kinematics.joint_unit} away'
        )
    moving = np.zeros(1) if points.velocities is None else np.abs(points.velocities[0])
    k = int(np.argmax(moving))
    if moving[k] > AT_REST:
        raise Refused(
            f'{kinematics.joint_names[k]} would begin at {moving[k]:.4g} '
            f'{kinematics.joint_unit}/s: a trajectory begins at rest'
        )


def _curves(
    machine: Machine, start: JointStart, points: JointPoints
) -> Iterator[tuple[Curve, Array]]:
    """Curves to try, with the times (m,) at which they reach the points."""
    skipped = int(points.times[0] == 0.0)
    times = np.append(0.0, points.times[skipped:])
    positions = np.vstack([start.joints, points.positions[skipped:]])
    if len(times) == 1:
        times, positions = np.array([0.0, start.dt]), np.vstack([start.joints, start.joints])
    elif points.velocities is not None:
        still = np.zeros((1, positions.shape[1]))
        velocities = np.concatenate([still, points.velocities[skipped:]])
        first = points.accelerations[:1] if skipped else still
        accelerations = np.concatenate([first, points.accelerations[skipped:]])
        yield splines(times, positions, velocities, accelerations), points.times
        return
    most, limits = widest(times), machine.motion.for_plans.joint
    widths = narrowest(times, positions, limits.acceleration, NARROWEST * start.dt)
    for _ in range(ROUNDINGS):
        yield rounded_lines(times, positions, widths), points.times + 2 * widths[0]
        if (widths >= most).all():
            return
        widths = np.minimum(1.5 * widths, most)


def _plan(
    machine: Machine,
    start: JointStart,
    curve: Curve,
    ends: Array,
    numbers: tuple[int, ...],
    effort: Effort,
) -> JointTrajectory:
    count = int(np.clip(curve.duration / KNOT_STEP, FEWEST_KNOTS, MOST_KNOTS))
    effort.spend(count)
    rows = curve.at(np.linspace(0.0, curve.duration, count))[0]
    try:
        knots = machine.kinematics.forward_along(rows, start.pose)
    except NoSolution as error:
        raise Refused(f'on the trajectory: {error}') from error
    return JointTrajectory(machine.kinematics, curve, knots, frozen(ends), numbers)
