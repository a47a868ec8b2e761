"""What the page asks for: JSON texts; malformed ones raise InvalidInput."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from manipulator.errors import InvalidInput
from manipulator.formatting import shown

LONGEST = 1000
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


def parsed(text: str | bytes) -> str | Request:
    """A request; or 'state', 'nodes', which are to be answered."""
    if not isinstance(text, str) or len(text) > LONGEST:
        raise InvalidInput(f'needs a text of at most {LONGEST} characters')
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f'is not JSON: {error}') from error
    if not isinstance(message, dict):
        raise InvalidInput('needs an object')
    wanted = message.get('want')
    if wanted in ('state', 'nodes'):
        return str(wanted)
    do = message.get('do')
    if do in PLAIN:
        return Request(str(do))
    if not isinstance(do, str) or do not in NEEDS:
        raise InvalidInput(f'do: {shown(do)} is not known')
    return Request(do, **{key: READ[key](key, message.get(key)) for key in NEEDS[do]})


def _axis(key: str, value: Any) -> int:
    if type(value) is not int or not 0 <= value < 6:
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
