"""The status of the motion, and which statuses are new."""

from dataclasses import dataclass

from manipulator.states import MotionMode, MotionResult

OVERTAKEN = 'replaced by a newer command while the path was planned'
REPLACED = 'replaced by a newer trajectory'
STOPPED = 'stopped before it began'
TAKEN_OVER = 'the machine was taken over again while the path was planned'
"""Reasons of paths that are not executed."""


@dataclass(frozen=True)
class MotionStatus:
    """The contents of `motion_status`.

    mode: hold, move, path, cycle, jog. result: idle, planning (a path), moving, reached, refused,
    stopped. goal_stamp: of the goal that the result refers to. reason: of the result, or
    what limits a jog. percent: elapsed share of a path's time.
    """

    mode: MotionMode = MotionMode.HOLD
    result: MotionResult = MotionResult.IDLE
    goal_stamp: float = 0.0
    reason: str = ''
    percent: int | None = None


class MotionNews:
    """The statuses to publish: each that differs from the one before; refusals are counted."""

    def __init__(self) -> None:
        self.refusals = 0
        self.last_refusal = ''
        self._seen: MotionStatus | None = None
        self._last: MotionStatus | None = None
        self._new: list[MotionStatus] = []

    def update(self, status: MotionStatus) -> None:
        """The status of the active motion: published when it has changed."""
        if status != self._seen:
            self._seen = status
            self.add(status)

    def add(self, status: MotionStatus) -> None:
        """The result of one command, independent of the active motion."""
        if status == self._last:
            return
        self._last = status
        self._new.append(status)
        if status.result == MotionResult.REFUSED:
            self.refusals += 1
            self.last_refusal = status.reason

    def take(self) -> list[MotionStatus]:
        """The statuses to publish since the last call, oldest first."""
        taken, self._new = self._new, []
        return taken
