"""What people hear about the motion, and which of it is news."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MotionStatus:
    """What goes out on motion_status.

    mode: hold, move, path, cycle, jog. result: idle, planning (a path), moving, reached, refused,
    stopped. goal_stamp is that of the goal which the result is about. reason: why so, or what
    holds a jog back. percent: how much of a path's time is over.
    """

    mode: str = 'hold'
    result: str = 'idle'
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

    def look(self, status: MotionStatus) -> None:
        """The motion's own status: news when it is another than at the last look."""
        if status != self._seen:
            self._seen = status
            self.add(status)

    def add(self, status: MotionStatus) -> None:
        """What became of one command, which the motion itself need not know of."""
        if status == self._last:
            return
        self._last = status
        self._new.append(status)
        if status.result == 'refused':
            self.refusals += 1
            self.last_refusal = status.reason

    def take(self) -> list[MotionStatus]:
        """What is to be published since the last call, oldest first."""
        taken, self._new = self._new, []
        return taken
