"""Closes the loop of plans on the measured joints: docs/motion.md, section 7.

The reference, the joints of the active plan, is fed forward; a correction c is added to it:

    command = q_ref + c,   Δc = K·T·(q_ref(t − τ) − q_measured),   K·delay ≤ 0.3          (7.1)

one step in T = 3·delay, so that each is seen before the next. It changes only while a plan is
executed and until its goal is reached: at rest the command is constant, whatever is measured.
"""

from collections import deque
from math import ceil

import numpy as np

from manipulator.arrays import Array, Mask
from manipulator.errors import NoSolution
from manipulator.limits.constraints import Constraints
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.teleop.jog_modes import GAIN_TIMES_DELAY, Feedback
from manipulator.trajectory.following_error import Tolerances
from manipulator.trajectory.play import Play
from manipulator.trajectory.reserve import Reserve

LATEST = 3.0
"""Times the assumed delay that a measurement may be late."""

STEP = GAIN_TIMES_DELAY * LATEST
"""Of an error that one step corrects: K·T."""

MOST_CORRECTION = 0.25
"""Of the following tolerance of a joint: the largest correction."""

APPROACH_TICKS = 5.0
"""In which an error of the correction itself would vanish if no limit applied."""

SETTLED = 1e-6
"""rad or m within which joints are at rest, and a correction has come to its end."""

NOTABLE = 4.0
"""Dead bands of an offset that is not due to counts alone."""

CUTS = 8
"""Bisections of a correction that would break a limit."""


class Correction:
    """One machine's, in joint coordinates (n,), rad or m; changes once a tick.

    dead_band (n,): errors that cannot be told from none; following (n,): the following tolerance.
    delay: seconds from a measurement to the moment that its correction moves the joints.
    """

    def __init__(self, dead_band: Array, following: Array, delay: float, dt: float) -> None:
        self._dead_band, self._dt = dead_band, dt
        self._interval = ceil(STEP / Feedback.for_delay(delay).gain / dt)
        self._references: deque[Array] = deque(maxlen=self._interval + 1)
        self._is_new = False
        self._settled_ticks: Array = np.zeros(len(following))
        self._play = Play(dead_band, MOST_CORRECTION * following)
        self._reserve = Reserve(dt)
        self._error: Array = np.zeros(len(following))
        self._offset: Array = np.zeros(len(following))
        self._rate: Array = np.zeros(len(following))

    def measure(self, joints: Array) -> None:
        """Takes measured joints (n,)."""
        if self._references:
            rows = np.array(self._references)
            error = np.clip(joints, rows.min(axis=0), rows.max(axis=0)) - joints
            self._error = error - np.clip(error, -self._dead_band, self._dead_band)
            self._is_new = True

    def face(self, rows: Array) -> None:
        """Takes up the play for a motion that begins with joints (k, n)."""
        self._play.face(rows)

    @property
    def is_settled(self) -> bool:
        """Whether the command has come to the end of its correction."""
        return not self._is_moving.any()

    def share_to_turn(self, jacobian: Array, rows: Array, tolerances: Tolerances) -> float | None:
        """How much of joints (k, n) to come is left until play moves the tool beyond tolerance.

        0 while it is being taken up; None where no such joint turns.
        """
        rest = jacobian @ (self._play.offset - self._offset)
        if tolerances.violation(rest):
            return 0.0
        turns, play = self._play.next_turns(rows)
        shifts = np.abs(jacobian * play)
        is_notable = np.linalg.norm(shifts[:3], axis=0) > tolerances.distance
        is_notable |= np.linalg.norm(shifts[3:], axis=0) > tolerances.turn
        first = int(np.where(is_notable, turns, len(rows)).min())
        return None if first == len(rows) else first / len(rows)

    @property
    def has_play(self) -> bool:
        """Whether any joint's command is ahead of it."""
        return bool((np.abs(self._play.offset) > NOTABLE * self._dead_band).any())

    @property
    def _is_moving(self) -> Mask:
        rest = np.abs(self._play.offset - self._offset)
        moving: Mask = rest > self._dead_band / 2 + SETTLED
        return moving

    def step(
        self, machine: Machine, pose: Pose, joints: Array, is_active: bool, is_stream: bool = False
    ) -> Pose:
        """The pose to command for the reference's pose and joints (n,) of this tick.

        The correction stays as it is while it is not active, and is cut where the command would
        break a limit of the machine. is_stream: see `Reserve.note`.
        """
        self._references.append(joints)
        self._reserve.note(pose, joints, is_stream)
        self._play.move(joints)
        if is_active and self._is_new:
            self._learn()
        self._is_new = False
        self._settled_ticks = np.where(self._is_moving, 0, self._settled_ticks + 1)
        if not (self._play.offset.any() or self._offset.any()):
            return pose
        self._advance(machine, pose, joints, is_active)
        return self._within_limits(machine, pose, joints)

    def _learn(self) -> None:
        """Corrects the joints whose last step can be seen in the measurement by now."""
        is_seen = self._settled_ticks > self._interval
        is_still = np.ptp(np.array(self._references), axis=0) <= SETTLED
        is_off = self._error != 0.0
        self._play.add(np.where(is_seen, STEP * self._error, 0.0), is_still)
        self._play.confirm(is_seen & is_still & ~is_off)
        self._settled_ticks = np.where(is_seen & is_off, 0, self._settled_ticks)

    def _advance(self, machine: Machine, pose: Pose, joints: Array, is_active: bool) -> None:
        """One tick towards the learned offset, within what the reference leaves of the limits."""
        low, high = machine.joint_ranges
        low, high = (
            np.minimum(low + SETTLED - joints, 0.0),
            np.maximum(high - SETTLED - joints, 0.0),
        )
        rest = np.clip(self._play.offset, low, high) - self._offset
        try:
            jacobian = machine.kinematics.jacobian(pose, joints)
        except NoSolution:
            self._rate = np.zeros_like(self._rate)
            return
        rate = np.zeros_like(rest)
        if is_active:
            fastest = 1.0 / (APPROACH_TICKS * self._dt)
            rate = rest * self._reserve.speed_share(machine.motion, rest, jacobian @ rest, fastest)
        change = rate - self._rate
        share = self._reserve.change_share(machine.motion, change, jacobian @ change)
        self._rate = self._rate + share * change
        self._offset = self._offset + self._dt * self._rate

    def _within_limits(self, machine: Machine, pose: Pose, joints: Array) -> Pose:
        """The corrected pose, with the largest part of the correction that keeps the limits."""
        constraints = machine.constraints.stretched_to(pose, joints)
        whole = _admitted(machine, constraints, pose, joints + self._offset)
        if whole is not None:
            return whole
        corrected, least, most = pose, 0.0, 1.0
        for _ in range(CUTS):
            part = (least + most) / 2
            found = _admitted(machine, constraints, pose, joints + part * self._offset)
            if found is None:
                most = part
            else:
                corrected, least = found, part
        self._offset, self._rate = least * self._offset, np.zeros_like(self._rate)
        return corrected


def _admitted(
    machine: Machine, constraints: Constraints, near: Pose, joints: Array
) -> Pose | None:
    """The pose of joints (n,) close to `near`; None beyond a limit, and where there is none."""
    try:
        pose = machine.kinematics.forward(joints, near).pose
    except NoSolution:
        return None
    return pose if bool(constraints.admits(pose, joints)) else None
