"""Numbers that were probably meant in another unit: the hint at the end of a refusal."""

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from math import pi, radians
from typing import Any

import numpy as np

from manipulator.errors import InvalidInput, Unreachable
from manipulator.formatting import length
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

FAR = 20.0
"""Characteristic lengths from home beyond which millimetres are more likely than metres."""

A_TURN = 2 * pi + 1e-3
TURNS = ('roll', 'pitch', 'yaw')

FACTOR = 200.0
"""Between a length and the machine's size: beyond it, one of both is more likely in metres."""
SIZES_MM = (2.0, 1e5)
"""Of machines: below they are more likely in metres, above in micrometres."""


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


def out_of_proportion(geometry: Any, limits: Any) -> list[str]:
    """Lengths in these sections, as built, that contradict the machine's own size.

    The size is the median of all of them, but for offsets, which may be 0: these may be as small
    as they like.
    """
    lengths = [*_lengths('geometry', geometry), *_lengths('limits', limits)]
    told = [value for _, value, is_size in lengths if is_size]
    if not told:
        return []
    size = float(np.median(told))
    if not SIZES_MM[0] <= size <= SIZES_MM[1]:
        return [f'geometry: its lengths are about {size:.3g} mm: is it in another unit?']
    return [
        f'{place}: {value:.5g} in a machine of about {size:.3g} mm: is it in another unit?'
        for place, value, is_size in lengths
        if value > FACTOR * size or (is_size and value * FACTOR < size)
    ]


def _lengths(place: str, section: Any) -> Iterable[tuple[str, float, bool]]:
    """The largest length of each key in mm, and whether it is no mere offset."""
    for field in dataclasses.fields(section):
        value = getattr(section, field.name)
        if field.name.endswith('_mm') and value is not None:
            are_points = np.ndim(value) == 2
            points = np.asarray(value) if are_points else np.reshape(value, (-1, 1))
            is_height = field.name == 'home_height_mm' and value != 0.0
            is_size = are_points or is_height or field.metadata['range'][0] > 0.0
            yield f'{place}.{field.name}', float(np.linalg.norm(points, axis=1).max()), is_size


def check_pivot(kinematics: Kinematics, pivot: Pose) -> None:
    """Raises InvalidInput for a pivot (platform frame) that is far from the machine."""
    away = float(np.linalg.norm(pivot.position))
    most = FAR * kinematics.characteristic_length
    if away > most:
        raise InvalidInput(
            f'pivot {pivot.position.tolist()} is {length(away)} from the platform, at most '
            f'{length(most)} fit this machine: is it in another unit?'
        )
