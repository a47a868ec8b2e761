"""What a Joy message must hold before anything in it is believed."""

from collections.abc import Sequence

from manipulator.errors import InvalidInput
from manipulator.teleop.gamepad import Gamepad
from manipulator.words import counted

BEYOND_FULL = 1.05
"""Drivers that scale by an odd maximum exceed 1 a little."""

MAX_NUMBERS = 64


def check_numbers(gamepad: Gamepad, axes: Sequence[float], buttons: Sequence[int]) -> None:
    """Raises InvalidInput naming the index that is missing, not finite or out of range.

    One bad number makes the whole message bad, also where nothing is mapped to it: a driver that
    sends it cannot be believed in the rest.
    """
    if len(axes) > MAX_NUMBERS or len(buttons) > MAX_NUMBERS:
        raise InvalidInput(
            f'{counted(len(axes), "axis", "axes")} and {counted(len(buttons), "button")}, '
            f'at most {MAX_NUMBERS} of each'
        )
    for i, value in enumerate(axes):
        if not abs(value) <= BEYOND_FULL:
            raise InvalidInput(f'axis {i} is {value:g}, outside [-{BEYOND_FULL}, {BEYOND_FULL}]')
    for i, state in enumerate(buttons):
        if state not in (0, 1):
            raise InvalidInput(f'button {i} is {state}, needs 0 or 1')
    used: list[tuple[str, int, str]] = [
        ('axis', stick.axis, stick.moves) for stick in gamepad.sticks
    ]
    for name, press in gamepad.presses.items():
        used += [('axis', press.axis, name)] if press.axis is not None else []
        used += [('button', press.button, name)] if press.button is not None else []
    counts = {'axis': len(axes), 'button': len(buttons)}
    for kind, index, meaning in used:
        if index >= counts[kind]:
            raise InvalidInput(f'{kind} {index} ({meaning}) is missing: there are {counts[kind]}')
