"""What a machine may not meet: sections `surroundings` and `bodies` of a machine file.

docs/motion.md, section 1.
"""

import dataclasses
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field

import numpy as np

from manipulator.arrays import Array, frozen
from manipulator.config import PLACE_MM, SIZE_MM, key, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import shown
from manipulator.pose import Pose

FAR = 1e6
"""Metres: where a side of a box is that has none."""

STAY_IN, STAY_OUT = 1.0, -1.0
"""`side` of kernel/capsules.h."""

Point = tuple[float, float, float]
Corners = tuple[Point, Point]


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A box in the base frame, metres; corners (2, 3), the lower first.

    words: what a part does that is where it may not be, as 'meets the box table'.
    """

    words: str
    side: float
    corners: Array

    def __post_init__(self) -> None:
        """Freezes the corners."""
        object.__setattr__(self, 'corners', frozen(self.corners))

    @property
    def is_endless(self) -> bool:
        """Whether it has a side alone, as a floor, and so is no box to draw."""
        return bool(np.ptp(self.corners, axis=0).max() >= FAR)

    @property
    def numbers(self) -> Array:
        """As `struct box` of kernel/capsules.h (7,)."""
        return np.concatenate([[self.side], self.corners.ravel()])


@dataclass(frozen=True)
class BoxConfig:
    """A box with edges along the axes of the base frame; two corners, or centre and size."""

    name: str = key('what messages call it')
    corners_mm: Corners | None = quantity(
        *PLACE_MM, 'two corners opposite each other, in any order', default=None
    )
    centre_mm: Point | None = quantity(*PLACE_MM, 'with size_mm, instead of corners', default=None)
    size_mm: Point | None = quantity(*SIZE_MM, 'along x, y and z', default=None)

    def __post_init__(self) -> None:
        """Raises ConfigError unless one way of giving the box is complete."""
        given = self.corners_mm, self.centre_mm, self.size_mm
        if [value is not None for value in given] not in ([1, 0, 0], [0, 1, 1]):
            raise ConfigError(['needs either corners_mm, or centre_mm and size_mm'])
        if not self.name.strip():
            raise ConfigError(['name: is empty'])
        if self.corners_mm is not None:
            _check_corners('corners_mm', self.corners_mm)

    def obstacle(self) -> Obstacle:
        """The box to stay out of."""
        ends: tuple[object, object] | None = self.corners_mm
        if ends is None:
            centre, half = np.array(self.centre_mm), np.array(self.size_mm) / 2
            ends = centre - half, centre + half
        return Obstacle(f'meets the box {self.name}', STAY_OUT, _metres(*ends))


@dataclass(frozen=True)
class SurroundingsConfig:
    """The `surroundings` section of a machine file, base frame: all of it is optional."""

    floor_mm: float | None = quantity(
        *PLACE_MM,
        'height of the floor or table, which nothing that moves may meet',
        default=None,
    )
    boxes: tuple[BoxConfig, ...] = key('what nothing that moves may meet', default=())
    workspace_mm: Corners | None = quantity(
        *PLACE_MM, 'two corners of a box that nothing that moves may leave', default=None
    )

    def __post_init__(self) -> None:
        """Raises ConfigError for names that are there twice, and an empty workspace."""
        names = [box.name for box in self.boxes]
        problems = [
            f'boxes[{i}].name: {shown(name)} is there twice'
            for i, name in enumerate(names)
            if name in names[:i]
        ]
        if problems:
            raise ConfigError(problems)
        if self.workspace_mm is not None:
            _check_corners('workspace_mm', self.workspace_mm)

    def obstacles(self) -> tuple[Obstacle, ...]:
        """The floor, the boxes, the workspace box, as far as there are any."""
        return tuple(self._obstacles())

    def _obstacles(self) -> Iterator[Obstacle]:
        if self.floor_mm is not None:
            low, high = [-FAR, -FAR, 1e-3 * self.floor_mm], [FAR, FAR, FAR]
            yield Obstacle('meets the floor', STAY_IN, np.array([low, high]))
        yield from (box.obstacle() for box in self.boxes)
        if self.workspace_mm is not None:
            yield Obstacle('leaves the workspace box', STAY_IN, _metres(*self.workspace_mm))


@dataclass(frozen=True)
class BodiesConfig:
    """The `bodies` section of a machine file: how thick the parts are.

    Parts of which it says so may not meet each other; all others are lines, that meet surroundings
    alone.
    """

    link_diameters_mm: tuple[float, ...] | None = quantity(
        *SIZE_MM, 'of an arm: base, links 1 to 5, link 6 with the tool', default=None
    )
    rod_diameter_mm: float | None = quantity(
        *SIZE_MM, "of a platform's rods, struts or linear legs", default=None
    )
    crank_diameter_mm: float | None = quantity(*SIZE_MM, 'of cranks', default=None)
    platform_thickness_mm: float | None = quantity(
        *SIZE_MM, 'of the platform along the lines from joint to joint', default=None
    )
    base_thickness_mm: float | None = quantity(*SIZE_MM, 'of the base, likewise', default=None)

    def check_keys(self, known: Collection[str], kind: str) -> None:
        """Raises ConfigError for keys of parts that a kind of machine does not have."""
        problems = [
            f'bodies.{f.name}: {kind} has no such parts'
            for f in dataclasses.fields(self)
            if getattr(self, f.name) is not None and f.name not in known
        ]
        if problems:
            raise ConfigError(problems)


@dataclass(frozen=True, eq=False)
class Bodies:
    """The parts of a machine as capsules: segments (..., m, 6) of a pose and its joints (...).

    A segment is its two ends in the base frame. radii (m,) in metres; pairs are of parts that may
    not meet, `moving` are those that may meet no obstacle.
    """

    names: tuple[str, ...]
    radii: Array
    pairs: tuple[tuple[int, int], ...]
    moving: tuple[int, ...]
    segments: Callable[[Pose, Array], Array] = field(repr=False)


def _metres(one: object, other: object) -> Array:
    """Lower and upper corner (2, 3) of two in millimetres."""
    corners = 1e-3 * np.array([one, other], dtype=np.float64)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


def _check_corners(name: str, corners: Corners) -> None:
    sizes = zip('xyz', *corners, strict=True)
    flat = [axis for axis, a, b in sizes if a == b]
    if flat:
        raise ConfigError([f'{name}: has no size along {", ".join(flat)}'])
