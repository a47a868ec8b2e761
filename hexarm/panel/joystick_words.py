"""What pages and the joystick say to each other, as JSON text; bad words raise InvalidInput."""

import json
import math
from typing import Any

from hexarm.panel.joystick import Beat
from manipulator.arrays import frozen
from manipulator.errors import InvalidInput

LONGEST = 1000
MOST_PRESSES = 1 << 31
AXES = 6


def heard(text: str | bytes) -> Beat | int:
    """A beat, or the number of a press that was released."""
    if not isinstance(text, str) or len(text) > LONGEST:
        raise InvalidInput(f'needs a text of at most {LONGEST} characters')
    try:
        words = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f'is no JSON: {error}') from error
    if not isinstance(words, dict):
        raise InvalidInput('needs an object')
    press = words.get('press')
    if type(press) is not int or not 0 <= press < MOST_PRESSES:
        raise InvalidInput('press needs a whole number from 0')
    if words.get('released') is True:
        return press
    tick = words.get('tick')
    return Beat(press, None if tick is None else _number('tick', tick), _stick(words))


def answer(tick: float, has_it: bool, is_taken: bool, reason: str) -> str:
    """What the page needs for its next beat and for its one line of text."""
    return json.dumps({'tick': tick, 'has_it': has_it, 'is_taken': is_taken, 'reason': reason})


def _stick(words: dict[str, Any]) -> Any:
    stick = words.get('stick')
    if not isinstance(stick, list) or len(stick) != AXES:
        raise InvalidInput(f'stick needs {AXES} numbers')
    return frozen([min(max(_number('stick', part), -1.0), 1.0) for part in stick])


def _number(name: str, value: Any) -> float:
    if type(value) not in (int, float) or not math.isfinite(value):
        raise InvalidInput(f'{name} needs finite numbers')
    return float(value)
