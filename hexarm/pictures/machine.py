"""A machine at a pose: seen from above and from two sides, and in space, with its measures."""

from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.proj3d import proj_transform

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
NAME_SIZE = 8
"""Points of the text of a length in space."""
ALONG = np.linspace(0.0, 1.0, 9)
NAMED = ('crank', 'rod', 'link')
"""Parts of which the first has its length beside it."""
AWAY = (3.0, 9.0, 16.0, 24.0)
"""Points from a part to its length: the nearest of those that are clear."""
CORNERS = np.array([[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)])
ENOUGH = 1.2
ROOM = 0.24
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
        _view(axes, strokes, across, pose)
        axes.set_title(title, loc='left', color=style.SOFT)
        (_radii if across == (0, 1) else _heights)(axes, strokes, across, pose)
    _space(figure.add_axes((0.5, 0.47, 0.48, 0.45), projection='3d'), strokes)
    figure.text(0.55, 0.915, ', '.join(_lengths(strokes)), size=9)
    return style.save(figure, picture)


def _in_millimetres(strokes: Iterable[Stroke]) -> Strokes:
    return [(stroke.part, 1e3 * stroke.points) for stroke in strokes]


def _place(pose: Pose) -> str:
    x, y, z = 1e3 * pose.position + 0.0
    roll, pitch, yaw = np.round(np.degrees(pose.rpy), 3) + 0.0
    return (
        f'x {x:.4g}, y {y:.4g}, z {z:.5g} mm; roll {roll:.4g}°, pitch {pitch:.4g}°, yaw {yaw:.4g}°'
    )


def _view(axes: Axes, strokes: Strokes, across: tuple[int, int], pose: Pose) -> None:
    """The projection, joints as dots, numbered from above."""
    for part, points in strokes:
        axes.plot(*points[:, across].T, **PARTS.get(part, PARTS['rod']))
        if part in ('crank', 'rod'):
            axes.plot(*points[:, across].T, 'o', color=style.INK, ms=3)
    ends = np.stack([np.zeros(3), 1e3 * pose.position])  # of the measure of its height
    points = np.concatenate([*(points for _, points in strokes), ends])
    low, high = _framed(axes, points[:, across])
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


def _of(strokes: Strokes, part: str) -> list[Array]:
    return [points for each, points in strokes if each == part]


def _legs(strokes: Strokes) -> list[Array]:
    """The parts by which the legs begin, of the lowest platform; none of an arm."""
    return (_of(strokes, 'crank') or _of(strokes, 'rod'))[:LEGS]


def _number_legs(axes: Axes, strokes: Strokes) -> None:
    """Beside the joints on the base."""
    legs = _legs(strokes)
    centre = np.mean([leg[0] for leg in legs], axis=0) if legs else np.zeros(3)
    for k, leg in enumerate(legs, start=1):
        place = centre + 1.12 * (leg[0] - centre)
        axes.text(place[0], place[1], str(k), weight='bold', **NUMBER)


def _radii(axes: Axes, strokes: Strokes, across: tuple[int, int], pose: Pose) -> None:
    """The circles of base and platform joints, where joints are on one, with their radii."""
    base = np.array([leg[0] for leg in _legs(strokes)])
    platform = _of(strokes, 'platform')[-1][:-1] if len(base) else base
    for points, colour, turn in ((base, style.INK, -0.25), (platform, style.AXES[0], 2.6)):
        if len(points):
            _radius(axes, points, colour, turn)
    if _of(strokes, 'link'):
        end = 1e3 * pose.position[:2]
        _arrow(axes, np.zeros(2), end, f'{np.linalg.norm(end):.4g}', 0.5)


def _radius(axes: Axes, points: Array, colour: str, turn: float) -> None:
    """The circle through the points, if they are on one, and an arrow to it."""
    centre = points.mean(axis=0)
    away = np.linalg.norm((points - centre)[:, :2], axis=1)
    if np.ptp(away) > 0.02 * away.mean():
        return
    radius = float(away.mean())
    axes.add_patch(plt.Circle(centre[:2], radius, fill=False, color=colour, lw=0.6, ls=':'))
    end = centre[:2] + radius * np.array([np.cos(turn), np.sin(turn)])
    _arrow(axes, centre[:2], end, f'R {radius:.4g}', 0.55)


def _heights(axes: Axes, strokes: Strokes, across: tuple[int, int], pose: Pose) -> None:
    """From the base frame to the platform or the tool, beside the machine."""
    points = np.concatenate([points for _, points in strokes])
    side = points[:, across[0]].max()
    beside = side + 0.62 * ROOM * float(np.ptp(points, axis=0)[list(across)].max())
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
    """With the lengths of links, or of the first leg's parts, beside them."""
    for part, points in strokes:
        axes.plot(*points.T, **PARTS.get(part, PARTS['rod']))
    style.space(axes, 0.88)
    axes.view_init(elev=24, azim=-58)
    _name_lengths(axes, strokes)


def _pairs(points: Iterable[Array]) -> list[tuple[Array, Array]]:
    """The ends in mm of all parts that have a length."""
    pairs = (pair for part in points for pair in pairwise(part))
    return [pair for pair in pairs if np.linalg.norm(pair[1] - pair[0]) > SHORTEST]


def _name_lengths(axes: Axes3D, strokes: Strokes) -> None:
    """The length of each part beside it, clear of all parts and of the other lengths."""
    axes.figure.draw_without_rendering()  # sets the projection
    taken: list[Array] = []
    for pair in _pairs(points for _, points in strokes):
        begin, end = _on_paper(axes, np.stack(pair))
        taken += [begin + s * (end - begin) for s in ALONG]
    for pair in _pairs(_of(strokes, part)[0] for part in NAMED if _of(strokes, part)):
        text = f'{np.linalg.norm(pair[1] - pair[0]):.4g}'
        half = NAME_SIZE * np.array([0.35 * len(text), 0.6])
        place = _clear_place(_on_paper(axes, np.stack(pair)), half, taken)
        axes.annotate(
            text, tuple(place), xycoords='figure points', size=NAME_SIZE, weight='bold',
            ha='center', va='center',
        )  # fmt: skip
        taken += [place + half * corner for corner in CORNERS]


def _clear_place(part: Array, half: Array, taken: list[Array]) -> Array:
    """The nearest place beside a part (2, 2) that is clear for a text of twice `half` (2,)."""
    along = part[1] - part[0]
    across = np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), 1.0)
    places = [
        part.mean(axis=0) + side * (away + abs(across) @ half) * across
        for away in AWAY
        for side in (1.0, -1.0)
    ]
    return max(places, key=lambda place: _clearance(place, half, taken))


def _on_paper(axes: Axes3D, points: Array) -> Array:
    """Points (n, 3) in mm as points (n, 2) of 1/72 inch from the figure's lower left."""
    x, y, _ = proj_transform(*points.T, axes.get_proj())
    pixels = np.asarray(axes.transData.transform(np.column_stack([x, y])))
    return np.asarray(pixels * 72.0 / axes.figure.dpi)


def _clearance(place: Array, half: Array, taken: list[Array]) -> float:
    """How far the nearest taken point is from a text, in halves of its size; at most ENOUGH."""
    away = np.abs((np.array(taken) - place) / half).max(axis=1)
    return float(np.floor(min(away.min(), ENOUGH) * 10) / 10)
