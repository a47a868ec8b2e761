"""How far the parts of a machine are from each other and from what stands around it: a limit.

docs/kinematics.md, section 11; the distances are computed in kernel/capsules.c.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from manipulator import _kernel
from manipulator.arrays import Array, Mask, frozen, stretched
from manipulator.kinematics import Kinematics
from manipulator.limits.limit import Bounds, BrakingPaths, LimitGroup, Search
from manipulator.limits.surroundings import Bodies, Obstacle
from manipulator.pose import Pose

Indices: TypeAlias = NDArray[np.intp]

HALVINGS = 20
"""Of the line to a pose that is too near to something."""

A_LIMIT = 1.0
"""`obstacle` of kernel/braking.h."""


@dataclass(frozen=True, eq=False)
class Clearance:
    """A `Limit`: every clearance at least 0, its owner a sentence as 'link 3 meets the floor'.

    group and columns: see `Grouped`.
    """

    bodies: Bodies
    obstacles: tuple[Obstacle, ...]
    group: LimitGroup | None = None
    columns: slice = field(default_factory=lambda: slice(0))
    quantity: str = ''
    unit: str = 'm'
    owners: tuple[str, ...] = field(init=False)
    low: Array = field(init=False)
    high: Array = field(init=False)
    _of_pairs: tuple[Indices, Indices, Array] = field(init=False, repr=False)
    _of_boxes: tuple[Indices, Array, Array] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Lays out what the kernel is given: who meets whom, and the radii between them."""
        names, radii = self.bodies.names, self.bodies.radii
        first, second = np.array(self.bodies.pairs, dtype=np.intp).reshape(-1, 2).T
        faced = [(part, box) for part in self.bodies.moving for box in self.obstacles]
        parts = np.array([part for part, _ in faced], dtype=np.intp)
        boxes = np.array([box.numbers for _, box in faced]).reshape(-1, 7)
        owners = [f'{names[i]} meets {names[k]}' for i, k in self.bodies.pairs]
        owners += [f'{names[part]} {box.words}' for part, box in faced]
        for name, value in {
            'owners': tuple(owners),
            'low': frozen(np.zeros(len(owners))),
            'high': frozen(np.full(len(owners), np.inf)),
            '_of_pairs': (first, second, radii[first] + radii[second]),
            '_of_boxes': (parts, boxes, radii[parts]),
        }.items():
            object.__setattr__(self, name, value)

    def values(self, pose: Pose, joints: Array) -> Array:
        """Metres (..., k) to each meeting, negative where parts overlap; pairs of parts first."""
        segments = self.bodies.segments(pose, joints)
        first, second, widths = self._of_pairs
        parts, boxes, radii = self._of_boxes
        lead = segments.shape[:-2]
        between, room = np.empty((*lead, len(first))), np.empty((*lead, len(parts)))
        if first.size:
            one, other = (np.take(segments, index, axis=-2) for index in (first, second))
            _kernel.segment_distance(one, other, between)
        if parts.size:
            own = np.take(segments, parts, axis=-2)
            _kernel.box_clearance(own, stretched(boxes, (*room.shape, 7)), room)
        return np.concatenate([between - widths, room - radii], axis=-1)


@dataclass(frozen=True, eq=False)
class ClearGroup:
    """A platform's `LimitGroup` with clearances after its own values.

    ranges are those of `inner` in a row, followed by the least clearances.
    """

    inner: LimitGroup
    clearance: Clearance
    kinematics: Kinematics
    _shape: tuple[int, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Learns how `inner` lays out its ranges."""
        object.__setattr__(self, '_shape', self.inner.ranges([]).shape)

    @property
    def of_pose(self) -> slice:
        """See `LimitGroup`."""
        return self.inner.of_pose

    @property
    def columns(self) -> slice:
        """Of the clearances, from the end: those of `inner` stay where they are."""
        return slice(-len(self.clearance.owners), None)

    def limited_values(self, pose: Pose, joints: Array) -> Array:
        """See `LimitGroup`."""
        own = self.inner.limited_values(pose, joints)
        return np.concatenate([own, self.clearance.values(pose, joints)], axis=-1)

    def ranges(self, bounds: Sequence[Bounds]) -> Array:
        """See `LimitGroup`."""
        least = np.full(len(self.clearance.owners), -np.inf)
        for columns, low, _ in bounds:
            if columns == self.columns:
                least = np.maximum(least, low)
        inner = self.inner.ranges([b for b in bounds if b[0] != self.columns])
        return np.concatenate([inner.ravel(), least])

    def keeps(self, ranges: Array, pose: Pose, joints: Array) -> Mask:
        """See `LimitGroup`."""
        inner, least = self._parted(ranges)
        kept = self.inner.keeps(inner, pose, joints)
        clear = (self.clearance.values(pose, joints) >= least).all(axis=-1)
        return np.asarray(kept & clear)

    def descended(self, search: Search, bounds: Sequence[Bounds], start: Pose) -> Pose:
        """See `LimitGroup`; where parts would meet there, on the line to it, before they do."""
        inner = [b for b in bounds if b[0] != self.columns]
        end, ranges = self.inner.descended(search, inner, start), self.ranges(bounds)
        ranges[-len(self.clearance.owners) :] += search.clearance
        way, free, beyond = start.twist_to(end), 0.0, 2.0
        for _ in range(HALVINGS):
            share = (free + beyond) / 2
            pose = start.moved(share * way) @ Pose(-search.pivot, np.eye(3))
            if self.keeps(ranges, pose, self.kinematics.inverse_or_nan(pose)):
                free = share
                if share == 1.0:
                    break
            else:
                beyond = share
        return start.moved(free * way)

    def first_free_path(self, ranges: Array, paths: BrakingPaths) -> tuple[int, Array]:
        """See `LimitGroup`: the first path that `inner` lets by, of those that meet nothing.

        Paths are for the parts of one twist, from the largest: smaller parts meet less.
        """
        inner, least = self._parted(ranges)
        count, met = len(paths.twists), np.zeros((len(paths.twists), 14 + len(paths.joints)))
        first = self._first_clear(least, paths, met)
        if first == count:
            return count, met
        free, met[first:] = self.inner.first_free_path(
            inner, replace(paths, twists=paths.twists[first:])
        )
        found = first + free
        is_checked = found in (first, count) or self._is_clear(least, paths, found, met)
        return (found if is_checked else count), met

    def _first_clear(self, least: Array, paths: BrakingPaths, met: Array) -> int:
        """The largest of the twists with a path that meets nothing, by bisection; or how many."""
        if self._is_clear(least, paths, 0, met):
            return 0
        blocked, free = 0, len(paths.twists) - 1
        if free == 0 or not self._is_clear(least, paths, free, met):
            return len(paths.twists)
        while free - blocked > 1:
            middle = (blocked + free) // 2
            if self._is_clear(least, paths, middle, met):
                free = middle
            else:
                blocked = middle
        return free

    def _is_clear(self, least: Array, paths: BrakingPaths, index: int, met: Array) -> bool:
        """Whether a path meets nothing; where it does, as `braking_path`, is put into `met`."""
        poses = paths.poses(paths.twists[index])
        own = paths.of_platform(poses)
        joints = self.kinematics.inverse_or_nan(own, paths.joints)
        clear: Mask = np.logical_and.reduce(self.clearance.values(own, joints) >= least, axis=-1)
        if clear.all():
            return True
        tick = int(np.argmin(clear))
        at = poses[tick]
        parts = [A_LIMIT, 0.0], at.position, at.rotation.ravel(), joints[tick]
        met[index] = np.concatenate(parts)
        return False

    def _parted(self, ranges: Array) -> tuple[Array, Array]:
        count = len(self.clearance.owners)
        return ranges[:-count].reshape(self._shape), ranges[-count:]
