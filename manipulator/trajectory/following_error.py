"""The following error of the joints, and their arrival at a goal."""

from collections import deque
from dataclasses import dataclass
from math import radians

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.deadlines import FOLLOWING_PATIENCE
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.states import MotionResult
from manipulator.trajectory.motion_status import MotionStatus

WINDOW = 0.5
"""Seconds by which the joints may lag behind."""

ARRIVAL_PATIENCE = 1.0
"""Seconds that the joints may take to arrive once a plan's time is over."""

CORRECTION_DELAYS = 20.0
"""Measurement delays that their correction may take besides: six times its time constant."""

TAKEOVER_SHARE = 0.1
"""Of the following tolerance: how far joints may be from the pose at takeover."""

MISMATCHES = 50
"""Poses in a row that do not match the joints before that is reported: some are only late."""

FOLLOWING_SHARE, MOST_FOLLOWING = 0.06, 0.2
"""Of a joint's range (and rad, for joints that turn) that it may be from its commands."""

GOAL_SHARE, MOST_AT_GOAL = 0.01, radians(0.5)
"""Of a joint's range (and rad) that a reported joint may be from where a goal sent it."""

DISTANCE_SHARE = 0.001
"""Of the characteristic length that a measured pose may be from the goal."""

COUNTS = 2.0
"""Steps of its resolution within which a joint is as near to its goal as it can come."""


@dataclass(frozen=True, eq=False)
class Tolerances:
    """How far each joint may be from its recent commands, and from a goal: (n,), rad or m.

    distance, turn: how far a measured pose may be from a goal, in m and rad. closest (n,): joints
    that are all within this are there, whatever their pose.
    """

    following: Array
    goal: Array
    distance: float
    turn: float
    closest: Array

    @classmethod
    def of(
        cls, machine: Machine, following: float = 0.0, goal: float = 0.0, distance: float = 0.0
    ) -> 'Tolerances':
        """One value for all joints (rad or m), or with 0 one by each joint's unit and range.

        distance: with 0 a share of the characteristic length, or what the joints' resolution
        allows; turns in proportion.
        """
        low, high = machine.joint_ranges
        is_rotary = machine.kinematics.joint_unit == 'rad'

        def each(value: float, share: float, most: float) -> Array:
            if value > 0.0:
                return frozen(np.full(len(low), value))
            return frozen(np.minimum(share * (high - low), most if is_rotary else np.inf))

        length = machine.kinematics.characteristic_length
        closest = COUNTS * dead_band_of(machine) * (distance == 0.0)
        distance = distance or DISTANCE_SHARE * length
        return cls(
            each(following, FOLLOWING_SHARE, MOST_FOLLOWING),
            each(goal, GOAL_SHARE, MOST_AT_GOAL),
            distance,
            distance / length,
            frozen(closest),
        )

    def violation(self, gap: Array) -> str:
        """How far a measured pose is from its goal, in words; '' within tolerance. gap: (6,)."""
        shift, turn = _sizes(gap)
        if shift <= self.distance and turn <= self.turn:
            return ''
        return (
            f'{missed(gap)} (tolerance {1e3 * self.distance:.3g} mm and '
            f'{np.degrees(self.turn):.2g}°)'
        )


def dead_band_of(machine: Machine) -> Array:
    """The resolution (n,) of a machine's joints, 0 where it is not known."""
    count = len(machine.kinematics.joint_names)
    return np.zeros(count) if machine.resolution is None else machine.resolution


def missed(gap: Array) -> str:
    """In words, what a twist (6,) leads from a goal to the pose instead."""
    shift, turn = _sizes(gap)
    return f'the goal is missed by {1e3 * shift:.3g} mm and {np.degrees(turn):.2g}°'


def _sizes(gap: Array) -> tuple[float, float]:
    return float(np.linalg.norm(gap[:3])), float(np.linalg.norm(gap[3:]))


class FollowingError:
    """Distance of the measured joints from all commands of the last half second."""

    def __init__(
        self, names: tuple[str, ...], unit: str, tolerances: Tolerances, dt: float
    ) -> None:
        """Unit: 'rad' or 'm'; dt is the time between two commands."""
        self._names, self._unit = names, unit
        self._tolerances = tolerances
        self._commanded: deque[Array] = deque(maxlen=max(round(WINDOW / dt), 1))
        self._is_outside = 0
        self._allowed_ticks = round(FOLLOWING_PATIENCE / dt)
        self._ticks_outside = 0
        self._away: Array | None = None
        self._measured: Array | None = None

    def command(self, joints: Array) -> None:
        """Adds the command (n,) of this tick."""
        self._commanded.append(joints)
        self._ticks_outside += self._is_outside

    def measure(self, joints: Array) -> None:
        """Takes measured joints (n,)."""
        self._measured = joints
        if not self._commanded:
            return
        away = np.abs(np.array(self._commanded) - joints)
        nearest = away[int(np.argmin(away.max(axis=1)))]
        self._is_outside = int((nearest > self._tolerances.following).any())
        self._ticks_outside *= self._is_outside
        # Compared with the last command: between two earlier ones no single joint is at fault.
        self._away = away[-1]

    @property
    def deviation(self) -> str:
        """The joint that is farthest from the last command, in words; '' within the tolerance."""
        if self._measured is None or not self._commanded:
            return ''
        away = np.abs(self._commanded[-1] - self._measured)
        tolerance = self._tolerances.goal
        return self._furthest(away, tolerance, 'the goal') if (away > tolerance).any() else ''

    @property
    def is_closest(self) -> bool:
        """Whether every joint is as near to the last command as its resolution allows."""
        if self._measured is None or not self._commanded:
            return False
        away = np.abs(self._commanded[-1] - self._measured)
        return bool((away < self._tolerances.closest).all())

    @property
    def violation(self) -> str:
        """The joint that does not follow, in words; '' while all do."""
        if self._away is None or self._ticks_outside <= self._allowed_ticks:
            return ''
        return self._furthest(self._away, self._tolerances.following, 'its command')

    def _furthest(self, away: Array, tolerance: Array, what: str) -> str:
        """The joint farthest beyond its tolerance, in words."""
        k = int(np.argmax(away - tolerance))
        factor, unit = (1e3, ' mm') if self._unit == 'm' else (float(np.degrees(1.0)), '°')
        allowed = f'tolerance {tolerance[k] * factor:.3g}{unit}'
        words = f'{away[k] * factor:.3g}{unit} away from {what} ({allowed})'
        return f'{self._names[k]} is {words}'


class PoseMatch:
    """Whether a reported pose matches the reported joints: only there a machine is taken over."""

    def __init__(self, machine: Machine, tolerance: Array) -> None:
        """Tolerance (n,): the following tolerance of each joint."""
        self.reason = ''
        self._kinematics = machine.kinematics
        self._allowed = TAKEOVER_SHARE * tolerance
        self._mismatches = 0

    def fits(self, pose: Pose, joints: Array) -> bool:
        """Compares a platform pose, which may be late, with joints (n,).

        A mismatch that lasts sets `reason`: a leg is on the other branch and nearly straight.
        """
        gaps = np.abs(self._kinematics.inverse(pose, joints) - joints)
        if (gaps < self._allowed).all():
            return True
        self._mismatches += 1
        if self._mismatches == MISMATCHES:
            worst = int(np.argmax(gaps))
            self.reason = (
                f'its pose does not match {self._kinematics.joint_names[worst]}, which differs by '
                f'{gaps[worst]:.2g} {self._kinematics.joint_unit}: disable and enable it; it then '
                'parks'
            )
        return False

    def clear(self) -> None:
        """Forgets mismatches."""
        self._mismatches, self.reason = 0, ''


class Arrival:
    """Delays the result *reached* until the joints are there, with limited patience."""

    def __init__(self, dt: float, delay: float) -> None:
        """delay: seconds until the correction of a measured position moves the joints."""
        self._patience = round((ARRIVAL_PATIENCE + CORRECTION_DELAYS * delay) / dt)
        self._judged: MotionStatus | None = None
        self._waited = 0

    def has_judged(self, status: MotionStatus) -> bool:
        """Whether a status has been judged."""
        return status is self._judged

    def judged(self, status: MotionStatus, deviation: str) -> MotionStatus | None:
        """The status to report, once a tick; None for nothing new.

        A plan whose time has ended reports *reached*. deviation: which joint is not there yet, in
        words; when patience is over the result is *stopped*, with this reason.
        """
        if status is self._judged:
            return None
        is_late = status.result == MotionResult.REACHED and bool(deviation)
        self._waited = self._waited + 1 if is_late else 0
        if is_late and self._waited < self._patience:
            return None
        self._judged, self._waited = status, 0
        if is_late:
            return MotionStatus(status.mode, MotionResult.STOPPED, status.goal_stamp, deviation)
        return status
