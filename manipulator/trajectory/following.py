"""Whether the joints follow what is commanded, and whether they have arrived."""

from collections import deque
from dataclasses import dataclass
from math import radians

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.machine import Machine
from manipulator.trajectory.motion_status import MotionStatus

WINDOW = 0.5
"""Seconds by which the joints may lag behind."""

PATIENCE = 0.3
"""Seconds for which they may be elsewhere."""

ARRIVAL_PATIENCE = 1.0
"""Seconds that the joints may take to arrive once a plan's time is over."""

FOLLOWING_SHARE, MOST_FOLLOWING = 0.06, 0.2
"""Of a joint's range (and rad, for joints that turn) that it may be from its commands."""

GOAL_SHARE, MOST_AT_GOAL = 0.01, radians(0.5)
"""Of a joint's range (and rad) that a measured joint may be from where a goal sent it."""


@dataclass(frozen=True, eq=False)
class Tolerances:
    """How far each joint may be from its commands of late, and from a goal: (n,), rad or m."""

    following: Array
    goal: Array

    @classmethod
    def of(cls, machine: Machine, following: float = 0.0, goal: float = 0.0) -> 'Tolerances':
        """The same for all joints, or with 0 by each joint's unit and range."""
        low, high = machine.joint_ranges
        is_rotary = machine.kinematics.joint_unit == 'rad'

        def each(value: float, share: float, most: float) -> Array:
            if value > 0.0:
                return frozen(np.full(len(low), value))
            return frozen(np.minimum(share * (high - low), most if is_rotary else np.inf))

        return cls(
            each(following, FOLLOWING_SHARE, MOST_FOLLOWING), each(goal, GOAL_SHARE, MOST_AT_GOAL)
        )


class Following:
    """Compares measured joints with all that was commanded within the last half second."""

    def __init__(
        self, names: tuple[str, ...], unit: str, tolerances: Tolerances, dt: float
    ) -> None:
        """Unit: 'rad' or 'm'; dt is the time between two commands."""
        self._names, self._unit = names, unit
        self._tolerances = tolerances
        self._commanded: deque[Array] = deque(maxlen=max(round(WINDOW / dt), 1))
        self._strays = 0
        self._allowed_ticks = round(PATIENCE / dt)
        self._astray_for = 0
        self._worst = ''
        self._measured: Array | None = None

    def command(self, joints: Array) -> None:
        """Notes what is commanded at this tick."""
        self._commanded.append(joints)
        self._astray_for += self._strays

    def measure(self, joints: Array) -> None:
        """Notes where the joints are."""
        self._measured = joints
        if not self._commanded:
            return
        away = np.abs(np.array(self._commanded) - joints)
        nearest = away[int(np.argmin(away.max(axis=1)))]
        self._strays = int((nearest > self._tolerances.following).any())
        self._astray_for *= self._strays
        # All joints are between two commands then; the last one tells which of them stands still.
        self._worst, _ = self._furthest(away[-1], self._tolerances.following, 'its command')

    def missing(self, is_measured: bool) -> str:
        """Which joint is not where the last command sent it, and by how much; '' where all are.

        Measured joints are held to the goal's tolerance; of others only the commands are known.
        """
        if self._measured is None or not self._commanded:
            return ''
        tolerance = self._tolerances.goal if is_measured else self._tolerances.following
        away = np.abs(self._commanded[-1] - self._measured)
        worst, excess = self._furthest(away, tolerance, 'the goal')
        return worst if excess > 0.0 else ''

    @property
    def trouble(self) -> str:
        """Which joint does not follow, and by how much; '' while all do."""
        return self._worst if self._astray_for > self._allowed_ticks else ''

    def _furthest(self, away: Array, tolerance: Array, what: str) -> tuple[str, float]:
        """The joint that is worst off, in words, and by how much it is beyond its tolerance."""
        k = int(np.argmax(away - tolerance))
        factor, unit = (1e3, ' mm') if self._unit == 'm' else (float(np.degrees(1.0)), '°')
        allowed = f'tolerance {tolerance[k] * factor:.3g}{unit}'
        words = f'{away[k] * factor:.3g}{unit} away from {what} ({allowed})'
        return f'{self._names[k]} is {words}', float(away[k] - tolerance[k])


class Arrival:
    """Holds *reached* back until the joints are there, for as long as they may take."""

    def __init__(self, dt: float) -> None:
        self._dt = dt
        self._judged: MotionStatus | None = None
        self._waited = 0

    def has_judged(self, status: MotionStatus) -> bool:
        """Whether what is to be reported of a status has been."""
        return status is self._judged

    def judged(self, status: MotionStatus, missing: str) -> MotionStatus | None:
        """What is to be reported of a status that may be new, once a tick; None for nothing new.

        A plan whose time is over says *reached*. missing: what is not there yet, in words; what
        does not come in time ends the motion as *stopped*, with these.
        """
        if status is self._judged:
            return None
        is_late = status.result == 'reached' and bool(missing)
        self._waited = self._waited + 1 if is_late else 0
        if is_late and self._waited * self._dt < ARRIVAL_PATIENCE:
            return None
        self._judged, self._waited = status, 0
        if is_late:
            return MotionStatus(status.mode, 'stopped', status.goal_stamp, missing)
        return status
