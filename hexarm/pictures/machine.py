"""A machine at a pose: seen from above and from two sides, and in space, with its measures."""

from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D

from hexarm.pictures import style
from manipulator.arrays import Array
from manipulator.links import Stroke
from manipulator.machine import Machine
from manipulator.pose import Pose

Strokes = list[tuple[str, Array]]
"""A part's name and its points (n, 3) in mm."""
PARTS: dict[str, dict[str, Any]] = {
    'body': {'color': style.INK, 'lw': 1.6},
    'platform': {'color': style.AXES[0], 'lw': 2.4},
    'crank': {'color': style.AXES[1], 'lw': 3.2, 'solid_capstyle': 'round'},
    'rod': {'color': style.SOFT, 'lw': 1.3},
    'link': {'color': style.AXES[0], 'lw': 3.0, 'solid_capstyle': 'round', 'marker': 'o', 'ms': 4},
}
"""By the parts of a skeleton."""
FIGURE = (style.WIDTH, 9.2)
MARK: dict[str, Any] = {'color': style.SOFT, 'lw': 0.7}
NUMBER: dict[str, Any] = {'color': style.INK, 'size': 8, 'ha': 'center', 'va': 'center'}
VIEWS = {'from above': (0, 1), 'from the side (−y)': (0, 2), 'from the front (+x)': (1, 2)}
LEGS = 6
"""Of which a stack numbers the lowest platform's."""
SHORTEST = 0.05
"""mm of a link with a length."""
ROOM = 0.2
"""Around a view, as a share of its size, for the measures."""


def draw(machine: Machine, pose: Pose, picture: Path, name: str) -> Path:
    """Saves the picture of the machine at a pose that it reaches (Unreachable otherwise)."""
    style.use()
    kinematics = machine.kinematics
    joints = kinematics.inverse(pose)
    strokes = _in_millimetres(kinematics.skeleton(pose, joints))
    figure = plt.figure(figsize=FIGURE, dpi=110)
    style.title(figure, name, f'{_place(pose)}; lengths in mm')
    places = iter(((0.06, 0.5, 0.42, 0.4), (0.06, 0.05, 0.42, 0.38), (0.55, 0.05, 0.42, 0.38)))
    for (title, across), place in zip(VIEWS.items(), places, strict=True):
        axes = figure.add_axes(place)
        _view(axes, strokes, across)
        axes.set_title(title, loc='left', color=style.SOFT)
        (_radii if across == (0, 1) else _heights)(axes, strokes, across, pose)
    _space(figure.add_axes((0.5, 0.47, 0.48, 0.45), projection='3d'), strokes)
    figure.text(0.55, 0.475, ', '.join(_lengths(strokes)), size=9)
    return style.save(figure, picture)


def _in_millimetres(strokes: Iterable[Stroke]) -> Strokes:
    return [(stroke.part, 1e3 * stroke.points) for stroke in strokes]


def _place(pose: Pose) -> str:
    x, y, z = 1e3 * pose.position + 0.0
    roll, pitch, yaw = np.round(np.degrees(pose.rpy), 3) + 0.0
    return (
        f'x {x:.4g}, y {y:.4g}, z {z:.5g} mm; roll {roll:.4g}°, pitch {pitch:.4g}°, yaw {yaw:.4g}°'
    )


def _view(axes: Axes, strokes: Strokes, across: tuple[int, int]) -> None:
    """The projection, joints as dots, numbered from above."""
    for part, points in strokes:
        axes.plot(*points[:, across].T, **PARTS.get(part, PARTS['rod']))
        if part in ('crank', 'rod'):
            axes.plot(*points[:, across].T, 'o', color=style.INK, ms=3)
    low, high = _framed(axes, np.concatenate([points for _, points in strokes])[:, across])
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.set(xlabel=f'{"xyz"[across[0]]} (mm)', ylabel=f'{"xyz"[across[1]]} (mm)')
    axes.grid(True)
    if across == (0, 1):
        _number_legs(axes, strokes)


def _framed(axes: Axes, points: Array) -> tuple[Array, Array]:
    """The lower left and upper right of a view, with room around and one scale for both axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    box = axes.get_position()
    shape = np.array([box.width, box.height]) * np.array(FIGURE)
    size = (high - low) + 2 * ROOM * max(*(high - low), 1.0)
    half = shape * float((size / shape).max()) / 2
    return (low + high) / 2 - half, (low + high) / 2 + half


def _number_legs(axes: Axes, strokes: Strokes) -> None:
    """Beside the joints on the base."""
    legs = [p for part, p in strokes if part == 'crank'] or [
        p for part, p in strokes if part == 'rod'
    ]
    centre = np.mean([leg[0] for leg in legs], axis=0) if legs else np.zeros(3)
    for k, leg in enumerate(legs[:LEGS], start=1):
        place = centre + 1.12 * (leg[0] - centre)
        axes.text(place[0], place[1], str(k), weight='bold', **NUMBER)


def _of(strokes: Strokes, part: str) -> list[Array]:
    return [points for each, points in strokes if each == part]


def _radii(axes: Axes, strokes: Strokes, across: tuple[int, int], pose: Pose) -> None:
    """The circles of base and platform joints, where joints are on one, with their radii."""
    for part, colour, turn in (('body', style.INK, -0.25), ('platform', style.AXES[0], 2.6)):
        for outline in _of(strokes, part)[-1:]:
            points = outline[:-1]
            centre = points.mean(axis=0)
            away = np.linalg.norm((points - centre)[:, :2], axis=1)
            if np.ptp(away) > 0.02 * away.mean():
                continue
            radius = float(away.mean())
            axes.add_patch(
                plt.Circle(centre[:2], radius, fill=False, color=colour, lw=0.6, ls=':')
            )
            end = centre[:2] + radius * np.array([np.cos(turn), np.sin(turn)])
            _arrow(axes, centre[:2], end, f'R {radius:.4g}', 0.55)
    if _of(strokes, 'link'):
        end = 1e3 * pose.position[:2]
        _arrow(axes, np.zeros(2), end, f'{np.linalg.norm(end):.4g}', 0.5)


def _heights(axes: Axes, strokes: Strokes, across: tuple[int, int], pose: Pose) -> None:
    """From the base frame to the platform or the tool, beside the machine."""
    points = np.concatenate([points for _, points in strokes])
    side = points[:, across[0]].max()
    beside = side + 0.45 * ROOM * float(np.ptp(points, axis=0)[list(across)].max())
    height = 1e3 * float(pose.position[2])
    for z, from_x in ((0.0, 0.0), (height, 1e3 * float(pose.position[across[0]]))):
        axes.plot([from_x, beside * 1.02], [z, z], lw=0.5, ls=(0, (6, 4)), color=style.SOFT)
    _arrow(
        axes, np.array([beside, 0.0]), np.array([beside, height]), f'{height:.5g}', 0.5, both=True
    )


def _arrow(
    axes: Axes, begin: Array, end: Array, text: str, share: float, both: bool = False
) -> None:
    axes.annotate(
        '', tuple(end), tuple(begin), arrowprops={'arrowstyle': '<->' if both else '->', **MARK}
    )
    place = begin + share * (end - begin)
    axes.text(
        place[0], place[1], text, **NUMBER, bbox={'fc': style.PAPER, 'ec': 'none', 'pad': 1.0}
    )


def _lengths(strokes: Strokes) -> list[str]:
    """Horns, rods and links, in words; a range where they differ."""
    found = []
    has_cranks = bool(_of(strokes, 'crank'))
    for part, word in (('crank', 'horns'), ('rod', 'rods' if has_cranks else 'legs')):
        some = [float(np.linalg.norm(points[-1] - points[0])) for points in _of(strokes, part)]
        if some:
            low, high = min(some), max(some)
            found.append(f'{word} {low:.4g}' + (f' … {high:.4g}' if high - low > 0.01 else ''))
    for points in _of(strokes, 'link'):
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        found.append(f'links {", ".join(f"{step:.4g}" for step in steps if step > SHORTEST)}')
    return [f'{text} mm' for text in found]


def _space(axes: Axes3D, strokes: Strokes) -> None:
    """With the lengths of links, or of the first leg's parts, on them."""
    for part, points in strokes:
        axes.plot(*points.T, **PARTS.get(part, PARTS['rod']))
    for part in ('crank', 'rod', 'link'):
        for points in _of(strokes, part)[:1]:
            for begin, end in pairwise(points):
                length = float(np.linalg.norm(end - begin))
                if length > SHORTEST:
                    axes.text(*((begin + end) / 2), f' {length:.4g}', size=8, weight='bold')
    style.space(axes, 0.88)
    axes.view_init(elev=24, azim=-58)
