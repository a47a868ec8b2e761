"""From a goal to a plan within all limits: slowed down where it is too fast, or refused."""

from dataclasses import dataclass, replace

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import Refused, Unreachable
from manipulator.machine import Machine
from manipulator.planning.check import check_plan
from manipulator.planning.cycle import Cycle
from manipulator.planning.flowing import plan_stream_move
from manipulator.planning.goal import Flow, Goal, Motion
from manipulator.planning.joint_move import KNOTS, plan_joint_move
from manipulator.planning.joint_stream import KNOTS as JOINT_KNOTS
from manipulator.planning.joint_stream import (
    MovingJoints,
    plan_joint_move_in_motion,
    plan_joint_stream,
)
from manipulator.planning.path_timing import TimedPath
from manipulator.planning.plan import Plan
from manipulator.planning.point_to_point import plan_line_move, plan_move_in_motion
from manipulator.planning.start import Start, plan_along_stream, slowed_down
from manipulator.planning.worker import Effort, TooLong
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres

FARTHEST = 1e5
"""Characteristic lengths from home beyond which nothing is computed: numbers would overflow."""

FORWARD_COST = 10
"""Poses of an inverse that a forward solution costs: no joint move is planned within a tick."""

ROUNDING = 1e-6
"""rad or m by which a joint move stays off the end of a range: ik solves its poses again for the
joints, and must not find one beyond it."""

SAME_JOINTS = 1e-3
"""rad or m within which joints count as the requested ones."""


def plan_goal(machine: Machine, start: Start, goal: Goal, effort: Effort) -> Plan:
    """The plan to a goal by its `motion`; a path or cycle that begins there is checked as well.

    Raises Unreachable when the goal itself is out of reach, and Refused when the path there is,
    cannot be slowed down enough, or costs more `effort` than a plan may.
    """
    refuse_absurd(machine, goal.pose)
    if goal.motion in (Motion.JOINT, Motion.UNWIND):
        begin, is_moving = start.joint_motion, not start.state.is_at_rest
        if begin is not None and goal.joints is not None and (goal.flow or is_moving):
            joints = _off_the_stops(machine, goal.joints)
            return _plan_joints_in_motion(machine, start, begin, joints, goal.flow, effort)
        return _plan_joints(machine, start, goal, effort)
    flow, limits = goal.flow, machine.motion.for_plans
    if flow is not None:
        flowing = plan_along_stream(
            machine, start, flow, effort,
            lambda how: plan_stream_move(start.state, goal.pose, flow, start.time, limits, how),
        )  # fmt: skip
        if flowing is not None:
            return flowing
    try:
        return _plan_line(machine, start, goal, effort)
    except Refused as refusal:
        if goal.motion is Motion.LINE or not start.state.is_at_rest:
            raise Refused(f'{refusal}{_hint(machine, start, goal, effort)}') from refusal
    return _plan_joints(machine, start, goal, effort)


@dataclass(frozen=True, eq=False)
class ComparedPlan:
    """A plan, and what it might take (s): along a line, by a joint move, at rated speed.

    None where no such move is found. rated: what the joint with the longest way needs at its speed
    limit, the other joints in proportion.
    """

    plan: Plan
    durations: dict[Motion, float | None]
    rated: float

    def __str__(self) -> str:
        found = [
            f'{motion.value} {"none" if t is None else f"{t:.2f} s"}'
            for motion, t in self.durations.items()
        ]
        return f'{", ".join(found)}; the joints at their speed limits alone: {self.rated:.2f} s'


def compared(machine: Machine, start: Start, goal: Goal, effort: Effort) -> ComparedPlan:
    """The plan of `plan_goal`, from rest, beside the other motions to the same goal."""
    plan = plan_goal(machine, start, goal, effort)
    durations: dict[Motion, float | None] = {}
    for motion in (Motion.LINE, Motion.JOINT):
        try:
            durations[motion] = plan_goal(
                machine, start, replace(goal, motion=motion), effort
            ).duration
        except (Refused, Unreachable, TooLong):
            durations[motion] = None
    end = machine.kinematics.inverse(goal.pose, start.joints)
    rated = np.abs(end - start.joints) / machine.motion.joint.speed
    return ComparedPlan(plan, durations, float(rated.max()))


def refuse_absurd(machine: Machine, pose: Pose) -> None:
    """Refused for a pose, finite as it is, that is farther away than any machine is large."""
    kinematics = machine.kinematics
    away = float(np.abs(pose.position - kinematics.home.position).max())
    most = FARTHEST * kinematics.characteristic_length
    if away > most:
        raise Refused(f'the goal is {away:.3g} m from home, needs at most {most:.3g} m')


def plan_to(machine: Machine, start: Start, pose: Pose, effort: Effort | None = None) -> Plan:
    """A move from any state of motion to rest at `pose` that keeps all limits at every tick.

    From rest it is straight, and stays on the branch that the machine is on. Raises as
    `plan_goal`.
    """
    limits = machine.motion.for_plans

    def line(slowdown: float) -> Plan:
        if start.state.is_at_rest:
            return plan_line_move(start.state.pose, pose, limits, slowdown)
        return plan_move_in_motion(start.state, pose, limits, slowdown)

    try:
        return slowed_down(machine, start, line, effort or Effort())
    except Refused:
        check_goal(machine, pose, start.joints)
        raise


def _plan_joints_in_motion(
    machine: Machine,
    start: Start,
    begin: MovingJoints,
    joints: Array,
    flow: Flow | None,
    effort: Effort,
) -> Plan:
    """A move to joints (n,) from the motion of others, along the stream that they continue."""
    cost = FORWARD_COST * JOINT_KNOTS

    def move(slowdown: float) -> Plan:
        effort.spend(cost)
        return plan_joint_move_in_motion(machine, begin, joints, slowdown)

    if flow is not None:
        effort.spend(cost)
        flowing = plan_along_stream(
            machine, start, flow, effort,
            lambda how: plan_joint_stream(machine, begin, joints, flow, start.time, how),
        )  # fmt: skip
        if flowing is not None:
            return flowing
    return slowed_down(machine, start, move, effort)


def _plan_joints(machine: Machine, start: Start, goal: Goal, effort: Effort) -> Plan:
    """A joint move from rest to a goal's joints, by default the nearest of its pose."""
    if not start.state.is_at_rest:
        raise Refused('a joint move begins at rest')
    effort.spend(FORWARD_COST * KNOTS)
    joints = goal.joints
    if joints is None:
        check_goal(machine, goal.pose, start.joints)
        near = None if goal.motion is Motion.UNWIND else start.joints
        joints = machine.kinematics.inverse(goal.pose, near)
    joints = _off_the_stops(machine, joints)

    def move(slowdown: float) -> Plan:
        return plan_joint_move(machine, start.state.pose, start.joints, joints, slowdown)

    plan = slowed_down(machine, start, move, effort)
    _check_arrival(machine, goal, joints, start.dt, effort)
    return plan


def check_goal(machine: Machine, goal: Pose, near: Array) -> None:
    """Raises Unreachable, naming leg, value and limit, when the machine cannot stand there.

    On the branch nearest to `near` or on home's: which it is, the path there decides.
    """
    inverse, constraints = machine.kinematics.inverse, machine.constraints
    with hint_at_metres(machine.kinematics, goal):
        joints = inverse(goal, near)
        if not (constraints.admits(goal, joints) or constraints.admits(goal, inverse(goal))):
            constraints.check(goal, joints)


def check_cycle(
    machine: Machine, cycle: Cycle, near: Array, dt: float, effort: Effort | None = None
) -> None:
    """Raises Refused when a cycle breaks a limit: its frequencies are never changed."""
    needed = check_plan(cycle, machine, near, dt, effort)
    if not needed.fits:
        raise Refused(
            f'cycle: {needed.quantity} is {needed.factor:.2f} times too fast: '
            'lower the frequencies by that factor, or the amplitudes'
        )


def _plan_line(machine: Machine, start: Start, goal: Goal, effort: Effort) -> Plan:
    """As `plan_to`, to a goal's joints where it names any."""
    plan = plan_to(machine, start, goal.pose, effort)
    if goal.joints is not None or goal.then is not None:
        times = np.append(np.arange(0.0, plan.duration, start.dt), plan.duration)
        joints = plan.joints_along(machine.kinematics, times, start.joints)[-1]
        _check_arrival(machine, goal, joints, start.dt, effort)
    return plan


def _off_the_stops(machine: Machine, joints: Array) -> Array:
    """`joints` (n,), those that stand at the end of their ranges a little inside."""
    low, high = machine.joint_ranges
    inside: Array = np.clip(joints, low + ROUNDING, high - ROUNDING)
    return np.where(np.abs(inside - joints) <= 2 * ROUNDING, inside, joints)


def _check_arrival(machine: Machine, goal: Goal, joints: Array, dt: float, effort: Effort) -> None:
    """Refused unless the goal can be met, and what it begins be driven, with `joints` (n,)."""
    if isinstance(goal.then, Cycle):
        check_cycle(machine, goal.then, joints, dt, effort)
    required = goal.then.joints if isinstance(goal.then, TimedPath) else goal.joints
    if required is None:
        return
    away = np.abs(joints - required)
    worst = int(np.argmax(away))
    if away[worst] > SAME_JOINTS:
        name, unit = machine.kinematics.joint_names[worst], machine.kinematics.joint_unit
        raise Refused(
            f'{name} would arrive {away[worst]:.3g} {unit} from its required position, '
            'on another branch of the inverse kinematics'
        )


def _hint(machine: Machine, start: Start, goal: Goal, effort: Effort) -> str:
    """What would reach a goal that no line move reaches, in words; '' where nothing would."""
    if not start.state.is_at_rest:
        return ''
    try:
        move = _plan_joints(machine, start, goal, effort)
    except (Refused, Unreachable):
        return ''
    except TooLong:
        if effort.is_whole:
            return ''
        raise
    return f'; a joint move reaches it in {move.duration:.1f} s (parameter goal_motion: joint)'
