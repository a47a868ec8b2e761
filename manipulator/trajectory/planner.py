"""From a goal to a move that the machine can drive: retimed where it is too fast, or refused."""

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.trajectory.check import check_plan
from manipulator.trajectory.cycle import Cycle
from manipulator.trajectory.move import plan_move
from manipulator.trajectory.plan import MotionState, Plan
from manipulator.trajectory.straight import plan_straight
from manipulator.unit_hints import hint_at_metres

ATTEMPTS = 8
MARGIN = 1.01
MOST_TICKS = 60_000
"""Of a move, all of which are checked: ten minutes at 100 Hz.

A way that would need more passes a singular posture, or changes branches: slowing down does not
help there.
"""


def check_goal(machine: Machine, goal: Pose, near: Array) -> None:
    """Raises Unreachable, naming leg, value and limit, when the machine cannot stand there.

    On the branch nearest to `near` or on home's: which it is, the way there decides.
    """
    inverse, constraints = machine.kinematics.inverse, machine.constraints
    with hint_at_metres(machine.kinematics, goal):
        joints = inverse(goal, near)
        if not (constraints.admits(goal, joints) or constraints.admits(goal, inverse(goal))):
            constraints.check(goal, joints)


def check_cycle(machine: Machine, cycle: Cycle, near: Array, dt: float) -> None:
    """Raises Refused when the machine cannot drive a cycle as it is: its speed is not ours."""
    needed = check_plan(cycle, machine, near, dt)
    if not needed.fits:
        raise Refused(
            f'cycle: {needed.quantity} is {needed.slowness:.2f} times too fast: '
            'lower the frequencies by that factor, or the amplitudes'
        )


def plan_to(machine: Machine, start: MotionState, goal: Pose, near: Array, dt: float) -> Plan:
    """A move from any state of motion to rest at `goal` that keeps all limits at every tick dt.

    From rest it is straight. near: the joints at the start. Raises Unreachable when the goal
    itself is out of reach, and Refused when the way there is, or cannot be slowed down enough.
    """
    check_goal(machine, goal, near)
    limits, slowness, quantity = machine.motion.for_plans, 1.0, ''
    for _ in range(ATTEMPTS):
        move: Plan
        if start.is_at_rest:
            move = plan_straight(start.pose, goal, limits, slowness)
        else:
            move = plan_move(start, goal, limits, slowness)
        _refuse_endless(move, quantity, dt)
        demand = check_plan(move, machine, near, dt)
        if demand.fits:
            return move
        slowness, quantity = slowness * demand.slowness * MARGIN, demand.quantity
    raise Refused(f'{quantity} stays above its limit at 1/{slowness:.3g} of full speed')


def _refuse_endless(move: Plan, quantity: str, dt: float) -> None:
    if move.checked_duration > MOST_TICKS * dt:
        reason = f': {quantity} is too high on it' if quantity else ''
        raise Refused(
            f'the way would take {move.checked_duration:.0f} s, at most {MOST_TICKS * dt:.0f} s'
            + reason
        )
