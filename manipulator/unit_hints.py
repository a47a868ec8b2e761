"""Numbers that were probably meant in another unit: the hint at the end of a refusal."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import pi, radians

import numpy as np

from manipulator.errors import InvalidInput, Unreachable
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

FAR = 20.0
"""Characteristic lengths from home beyond which millimetres are more likely than metres."""

A_TURN = 2 * pi + 1e-3
TURNS = ('roll', 'pitch', 'yaw')


@contextmanager
def hint_at_metres(kinematics: Kinematics, pose: Pose) -> Iterator[None]:
    """Adds to an Unreachable of a pose that is far away whether millimetres were meant."""
    try:
        yield
    except Unreachable as error:
        away = np.linalg.norm(pose.position - kinematics.home.position)
        if away > FAR * kinematics.characteristic_length:
            error.args = (f'{error}; are these millimetres? hexarm takes metres',)
        raise


def check_turns(angles: Sequence[float], names: Sequence[str] = TURNS) -> None:
    """Raises InvalidInput for angles of more than a turn: they are meant in degrees."""
    for name, value in zip(names, angles, strict=True):
        if abs(value) > A_TURN:
            raise InvalidInput(
                f'{name}: {value:g} rad is more than a turn; are these degrees? hexarm takes '
                f'radians: {value:g}° are {radians(value):.4g}'
            )
