"""Numbers that were probably meant in another unit: the hint at the end of a refusal."""

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from math import pi, radians
from typing import Any

import numpy as np

from manipulator.arrays import Array
from manipulator.errors import InvalidInput, Unreachable
from manipulator.formatting import length
from manipulator.frames import Tool
from manipulator.kinematics import Kinematics
from manipulator.pose import Pose

FAR = 20.0
"""Characteristic lengths from home beyond which millimetres are more likely than metres."""

A_TURN = 2 * pi + 1e-3
TURNS = ('roll', 'pitch', 'yaw')

FACTOR = 200.0
"""Between a length and the machine's size: beyond it, one of both is more likely in metres."""
LINK_RADIUS, LINK_END = 0.25, 0.01
"""Of an arm's last link, as parts of its length: how thick it is taken to be, and a rounding."""
TINY = 1e-9
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
    sizes = [value for _, value, is_size in lengths if is_size]
    if not sizes:
        return []
    size = float(np.median(sizes))
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


def check_tool(kinematics: Kinematics, tool: Tool) -> None:
    """Raises InvalidInput for a tool that is far from the machine or inside an arm's wrist."""
    name = f'tool {tool.name!r}'
    check_pivot(kinematics, tool.T_platform_tool, name)
    home = kinematics.home
    joints = kinematics.inverse(home)
    if any(stroke.part == 'link' for stroke in kinematics.skeleton(home, joints)):
        wrist = home.rotation.T @ _wrist(kinematics.jacobian(home, joints))
        _check_outside(wrist, tool.T_platform_tool.position, name)


def _wrist(jacobian: Array) -> Array:
    """Where an arm's last axis comes nearest to the one before it, (3,) from the platform (m).

    jacobian (6, 6) in base axes; the result too. A turn ω about an axis through p moves the
    platform's origin by v = p × ω.
    """
    (v, before), (u, last) = (np.split(column, 2) for column in jacobian.T[4:])
    gap = np.cross(before, v) - np.cross(last, u)
    cosine = float(before @ last)
    along = float(gap @ (last - cosine * before)) / max(1.0 - cosine**2, TINY)
    wrist: Array = np.cross(last, u) + along * last
    return wrist


def _check_outside(begin: Array, point: Array, name: str) -> None:
    """For a link (platform frame, m) from `begin` to the platform's origin, where tools begin."""
    size = float(np.linalg.norm(begin))
    along = float(point @ begin) / max(size, TINY)
    aside = float(np.linalg.norm(np.cross(point, begin))) / max(size, TINY)
    if LINK_END * size < along < size and aside < LINK_RADIUS * size:
        raise InvalidInput(
            f'{name} is inside the last link: {length(along)} behind its end, {length(aside)} '
            f'from its line, needs {length(LINK_RADIUS * size)} there'
        )


def check_pivot(kinematics: Kinematics, pivot: Pose, name: str = 'pivot') -> None:
    """Raises InvalidInput for a pivot (platform frame) that is far from the machine."""
    away = float(np.linalg.norm(pivot.position))
    most = FAR * kinematics.characteristic_length
    if away > most:
        raise InvalidInput(
            f'{name} {pivot.position.tolist()} is {length(away)} from the platform, at most '
            f'{length(most)} fit this machine: is it in another unit?'
        )
