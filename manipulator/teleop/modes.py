"""Jog modes by the names under which the `jog_mode` topic asks for them."""

import difflib
from collections.abc import Callable

from manipulator.arrays import Array
from manipulator.errors import Refused
from manipulator.teleop.feedback import Feedback
from manipulator.teleop.free import Free
from manipulator.teleop.hold_orientation import HoldOrientation
from manipulator.teleop.jog_mode import JogMode
from manipulator.teleop.look_at import LookAt
from manipulator.teleop.parallel_to_axis import ParallelToAxis
from manipulator.teleop.turn_about_axis import TurnAboutAxis


def jog_mode(name: str, feedback: Feedback, point: Array | None = None) -> JogMode:
    """The mode of that name; `point` (3,) in the base frame is what look_at looks at.

    Raises Refused for an unknown name, with the nearest known one, and for look_at without point.
    """
    check_name(name)
    return MODES[name](feedback, point)


def check_name(name: str) -> None:
    """Raises Refused for an unknown name, with the nearest known one."""
    if name not in MODES:
        near = difflib.get_close_matches(name[:80], MODES, n=1)
        hint = f', did you mean {near[0]!r}?' if near else ''
        raise Refused(f'jog mode {name[:80]!r} is not one of {list(MODES)}{hint}')


def _look_at(feedback: Feedback, point: Array | None) -> JogMode:
    if point is None:
        raise Refused('jog mode look_at: no point was given yet')
    return LookAt(feedback, point)


MODES: dict[str, Callable[[Feedback, Array | None], JogMode]] = {
    'free': lambda feedback, point: Free(),
    'hold_orientation': lambda feedback, point: HoldOrientation(feedback),
    'turn_base_x': lambda feedback, point: TurnAboutAxis(feedback, 0, 'base'),
    'turn_base_y': lambda feedback, point: TurnAboutAxis(feedback, 1, 'base'),
    'turn_base_z': lambda feedback, point: TurnAboutAxis(feedback, 2, 'base'),
    'turn_tool_x': lambda feedback, point: TurnAboutAxis(feedback, 0, 'tool'),
    'turn_tool_y': lambda feedback, point: TurnAboutAxis(feedback, 1, 'tool'),
    'turn_tool_z': lambda feedback, point: TurnAboutAxis(feedback, 2, 'tool'),
    'parallel': lambda feedback, point: ParallelToAxis(feedback),
    'look_at': _look_at,
}
