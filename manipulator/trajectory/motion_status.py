"""What people hear about the motion."""

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
