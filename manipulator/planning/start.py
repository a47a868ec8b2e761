"""Where a plan begins, in motion or at rest, and the moves from there that keep all limits."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import NoSolution, Refused
from manipulator.machine import Machine
from manipulator.planning.check import LimitUtilisation, check_plan
from manipulator.planning.flowing import ATTEMPTS, STILL, Attempt
from manipulator.planning.goal import Flow
from manipulator.planning.joint_stream import MovingJoints
from manipulator.planning.plan import MotionState, Plan
from manipulator.planning.worker import Effort

MOST_ATTEMPTS = 8
MARGIN = 1.01
"""By which a plan is slowed down further than the last attempt needed."""
MOST_SLOWDOWN = 30.0
"""Times that a move may take of what platform or tool alone would need: what joints that must turn
faster near a singular posture may cost."""


@dataclass(frozen=True, eq=False)
class Start:
    """Where a plan begins: a state of motion, the joints (n,) there; dt is a tick (s).

    time is when, on the clock of `Flow.due`. rates: of the joints, with their derivatives (n,);
    None in a motion of poses. before (n,): the joints a tick earlier, None if not known.
    """

    state: MotionState
    joints: Array
    dt: float
    time: float = 0.0
    rates: tuple[Array, Array] | None = None
    before: Array | None = None

    def checked(self, machine: Machine, plan: Plan, effort: Effort) -> LimitUtilisation:
        """`check_plan` from here; Refused, too, where the joints of a plan fix no pose."""
        try:
            return check_plan(plan, machine, self.joints, self.dt, effort, self.before)
        except NoSolution as error:
            raise Refused(f'on the joint move: {error}') from error

    @property
    def joint_motion(self) -> MovingJoints | None:
        """The joints in motion or at rest; None in a motion of poses."""
        still = np.zeros_like(self.joints)
        rates = (still, still) if self.state.is_at_rest else self.rates
        return None if rates is None else MovingJoints(self.state.pose, (self.joints, *rates))


def plan_along_stream(
    machine: Machine,
    start: Start,
    flow: Flow,
    effort: Effort,
    plan: Callable[[Attempt], Plan | None],
) -> Plan | None:
    """The move that follows a stream, None where it would pass a limit, or nothing moves."""
    if start.state.is_at_rest and np.abs(flow.twist).max() < STILL:
        return None
    for attempt in ATTEMPTS:
        try:
            move = plan(attempt)
            if move is not None and start.checked(machine, move, effort).fits:
                return move
        except Refused:
            continue
    return None


def slowed_down(
    machine: Machine, start: Start, plan: Callable[[float], Plan], effort: Effort
) -> Plan:
    """The first of ever slower plans within all limits; Refused where none is.

    plan: makes one for a slowdown k ≥ 1.
    """
    slowdown = 1.0
    for _ in range(MOST_ATTEMPTS):
        move = plan(slowdown)
        peak = start.checked(machine, move, effort)
        if peak.fits:
            return move
        slowdown *= peak.factor * MARGIN
        if slowdown > MOST_SLOWDOWN:
            break
    raise Refused(
        f'{move.where(peak.time)}: {peak.quantity} would still be above its limit at '
        f'1/{slowdown:.3g} of full speed, as near singular postures'
    )
