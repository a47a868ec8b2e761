"""What a drawing of the machine is made of: bars along strokes, balls at their ends, colours."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexarm.panel.bars import Bars, bars_between
from hexarm.panel.margins import colour
from manipulator.arrays import Array
from manipulator.skeleton import Stroke

RADII = {
    'body': 0.012,
    'crank': 0.022,
    'rod': 0.014,
    'platform': 0.016,
    'link': 0.055,
    'gripper': 0.011,
}
"""Of bars, by part, as shares of the machine's size."""

PLAIN = {
    'body': (58, 68, 82),
    'platform': (62, 104, 168),
    'link': (62, 104, 168),
    'gripper': (196, 140, 40),
}
"""Parts whose colour says nothing; cranks, rods and joints are coloured by their margins."""

COLUMNS = ('crank', 'rod')
"""Parts of which each leg has one, in the order of the legs."""

THIN_END = 0.45
BALL = 1.35
"""Radii of the tool's end and of balls, as shares of the bar's."""

Colours = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Pieces:
    """n bars and m balls of a stance, lengths in machine sizes.

    parts (n) and owners (n), ball_owners (m) say what each is of, and which leg's or joint's
    margin it shows ('' for none).
    """

    bars: Bars
    balls: Array
    ball_radii: Array
    parts: tuple[str, ...]
    owners: tuple[str, ...]
    ball_owners: tuple[str, ...]


def pieces(strokes: tuple[Stroke, ...]) -> Pieces:
    """Bars along every stroke and balls at every point of it."""
    owners = _owners(strokes)
    counts = [len(stroke.points) - 1 for stroke in strokes]
    radii = [_radii(stroke) for stroke in strokes]
    return Pieces(
        bars_between(
            np.vstack([stroke.points[:-1] for stroke in strokes]),
            np.vstack([stroke.points[1:] for stroke in strokes]),
            np.concatenate([radius[:-1] for radius in radii]),
        ),
        np.vstack([stroke.points for stroke in strokes]),
        BALL * np.concatenate(radii),
        tuple(s.part for s, n in zip(strokes, counts, strict=True) for _ in range(n)),
        tuple(o for o, n in zip(owners, counts, strict=True) for _ in range(n)),
        tuple(o for k, stroke in enumerate(strokes) for o in _ball_owners(stroke, owners[k])),
    )


def colours(parts: tuple[str, ...], owners: tuple[str, ...], left: dict[str, float]) -> Colours:
    """(n, 3): by margin where the piece has an owner, else the part's own."""
    found = [
        colour(left.get(owner, 1.0)) if owner else PLAIN[part]
        for part, owner in zip(parts, owners, strict=True)
    ]
    return np.array(found, dtype=np.uint8)


def _owners(strokes: tuple[Stroke, ...]) -> list[str]:
    """Whose each stroke is: cranks and rods are counted, each by itself."""
    counts: dict[str, int] = {}
    found = []
    for stroke in strokes:
        counts[stroke.part] = counts.get(stroke.part, 0) + 1
        found.append(f'leg {counts[stroke.part]}' if stroke.part in COLUMNS else '')
    return found


def _ball_owners(stroke: Stroke, owner: str) -> list[str]:
    """A serial arm's line goes from its base through six joints to the tool."""
    last = len(stroke.points) - 1
    if stroke.part != 'link':
        return [owner] * (last + 1)
    return ['', *(f'joint {k}' for k in range(1, last)), '']


def _radii(stroke: Stroke) -> Array:
    """(n,): at each point; arms get thinner towards the tool."""
    taper = np.linspace(1.0, THIN_END if stroke.part == 'link' else 1.0, len(stroke.points))
    radii: Array = RADII[stroke.part] * taper
    return radii
