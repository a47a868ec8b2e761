"""What pages send, JSON texts: requests of the controls, beats of the joystick.

Malformed ones raise InvalidInput.
"""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hexarm.panel.joystick import Beat
from manipulator.arrays import Array, frozen
from manipulator.errors import InvalidInput
from manipulator.formatting import shown

LONGEST = 1000
MOST_PRESSES = 1 << 31
AXES = 6
PLAIN = (
    'stop', 'enable', 'disable', 'clear', 'home', 'park', 'cycle', 'brake', 'pause', 'resume',
    'clear_trail',
)  # fmt: skip


@dataclass(frozen=True)
class Request:
    """A request by name, with what it needs: an axis (0 to 5), a value, a name."""

    do: str
    axis: int = 0
    value: float = 0.0
    name: str = ''


def request_of(text: str | bytes) -> str | Request:
    """A request; or 'state', 'nodes', which are to be answered."""
    message = _read(text)
    wanted = message.get('want')
    if wanted in ('state', 'nodes'):
        return str(wanted)
    do = message.get('do')
    if do in PLAIN:
        return Request(str(do))
    if not isinstance(do, str) or do not in NEEDS:
        raise InvalidInput(f'do: {shown(do)} is not known')
    return Request(do, **{key: READ[key](key, message.get(key)) for key in NEEDS[do]})


def beat_of(text: str | bytes) -> Beat | int:
    """A beat, or the number of a press that was released."""
    message = _read(text)
    press = message.get('press')
    if type(press) is not int or not 0 <= press < MOST_PRESSES:
        raise InvalidInput('press needs a whole number from 0')
    if message.get('released') is True:
        return press
    tick = message.get('tick')
    return Beat(press, None if tick is None else _number('tick', tick), _stick(message))


def answer(tick: float, has_it: bool, is_taken: bool, reason: str) -> str:
    """To a beat: what the page needs for its next one and for its one line of text."""
    return json.dumps({'tick': tick, 'has_it': has_it, 'is_taken': is_taken, 'reason': reason})


def _read(text: str | bytes) -> dict[str, Any]:
    if not isinstance(text, str) or len(text) > LONGEST:
        raise InvalidInput(f'needs a text of at most {LONGEST} characters')
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f'is not JSON: {error}') from error
    if not isinstance(message, dict):
        raise InvalidInput('needs an object')
    return message


def _stick(message: dict[str, Any]) -> Array:
    stick = message.get('stick')
    if not isinstance(stick, list) or len(stick) != AXES:
        raise InvalidInput(f'stick needs {AXES} numbers')
    return frozen([min(max(_number('stick', part), -1.0), 1.0) for part in stick])


def _axis(key: str, value: Any) -> int:
    if type(value) is not int or not 0 <= value < AXES:
        raise InvalidInput(f'{key} needs a whole number from 0 to 5')
    return value


def _number(key: str, value: Any) -> float:
    if type(value) not in (int, float) or not math.isfinite(value):
        raise InvalidInput(f'{key} needs a finite number')
    return float(value)


def _name(key: str, value: Any) -> str:
    if not isinstance(value, str):
        raise InvalidInput(f'{key} needs a text')
    return value


READ: dict[str, Callable[[str, Any], Any]] = {'axis': _axis, 'value': _number, 'name': _name}
NEEDS: dict[str, tuple[str, ...]] = {
    'goal': ('axis', 'value'), 'joint': ('name', 'value'), 'speed': ('value',), 'grip': ('value',),
    'share': ('value',), 'show_reach': ('value',), 'mode': ('name',), 'save': ('name',),
    'go_to': ('name',), 'delete': ('name',), 'tool': ('name',),
}  # fmt: skip
