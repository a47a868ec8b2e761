"""What people hear about the motion."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MotionStatus:
    """What goes out on motion_status.

    mode: hold, move, cycle, jog. result: idle, moving, reached, refused, stopped. goal_stamp is
    that of the goal which the result is about. reason: why so, or what holds a jog back.
    """

    mode: str = 'hold'
    result: str = 'idle'
    goal_stamp: float = 0.0
    reason: str = ''
