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

TOOL = 'tool'
"""The name of the part that a tool is, also of an arm's last link."""

HALVINGS = 20
"""Of the line to a pose that is too near to something."""

A_LIMIT = 1.0
"""`obstacle` of kernel/braking.h."""


@dataclass(frozen=True, eq=False)
class Clearance:
    """A `Limit`: every clearance at least 0, its owner a sentence as 'link 3 meets the floor'.

    tip (3,): the point of the tool in force, platform frame; None of a machine without tools. From
    the platform's origin to it is one more part. group and columns: see `Grouped`. names and radii
    are of the parts, the tool with them; pairs (2, n) of parts, and faced (2, m), a part and an
    obstacle, are what must not meet.
    """

    bodies: Bodies
    obstacles: tuple[Obstacle, ...]
    tip: Array | None = None
    group: LimitGroup | None = None
    columns: slice = field(default_factory=lambda: slice(0))
    quantity: str = ''
    unit: str = 'm'
    owners: tuple[str, ...] = field(init=False)
    low: Array = field(init=False)
    high: Array = field(init=False)
    names: tuple[str, ...] = field(init=False)
    radii: Array = field(init=False)
    pairs: Indices = field(init=False, repr=False)
    faced: Indices = field(init=False, repr=False)
    _boxes: Array = field(init=False, repr=False)
    _widths: Array = field(init=False, repr=False)
    _rows: tuple[Indices, Indices] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Lays out what the kernel is given: who meets whom, and the radii between them."""
        names, radii, moving = self.bodies.names, self.bodies.radii, self.bodies.moving
        if self.tip is not None:
            moving = (*moving, len(names))
            names, radii = (*names, TOOL), np.append(radii, self.bodies.tool_radius)
        boxes = range(len(self.obstacles))
        faced = [(part, box) for part in moving for box in boxes]
        owners = [f'{names[i]} meets {names[k]}' for i, k in self.bodies.pairs]
        owners += [f'{names[part]} {self.obstacles[box].words}' for part, box in faced]
        pairs, met = (
            np.array(some, dtype=np.intp).reshape(-1, 2).T.copy()
            for some in (self.bodies.pairs, faced)
        )
        unique = list(dict.fromkeys(owners))
        rows = np.array([unique.index(owner) for owner in owners], dtype=np.intp)
        order = np.argsort(rows, kind='stable')
        for name, value in {
            'owners': tuple(unique),
            'low': frozen(np.zeros(len(unique))),
            'high': frozen(np.full(len(unique), np.inf)),
            '_rows': (order, np.searchsorted(rows[order], np.arange(len(unique)))),
            'names': names,
            'radii': frozen(radii),
            'pairs': pairs,
            'faced': met,
            '_widths': np.concatenate([radii[pairs].sum(axis=0), radii[met[0]]]),
            '_boxes': np.array([self.obstacles[box].numbers for _, box in faced]).reshape(-1, 7),
        }.items():
            object.__setattr__(self, name, value)

    def values(self, pose: Pose, joints: Array) -> Array:
        """Metres (..., k) to each meeting, negative where parts overlap; pairs of parts first.

        Of capsules with one name, as the lines of a platform, the least.
        """
        everything = self.distances(self.segments(pose, joints))
        order, starts = self._rows
        if len(order) == len(starts):
            return everything
        least: Array = np.minimum.reduceat(np.take(everything, order, axis=-1), starts, axis=-1)
        return least

    def segments(self, pose: Pose, joints: Array) -> Array:
        """Those of `Bodies`, and the tool's."""
        segments = self.bodies.segments(pose, joints)
        if self.tip is None:
            return segments
        tool = np.concatenate([pose.position, pose.position + pose.rotation @ self.tip], axis=-1)
        one = stretched(tool[..., None, :], (*segments.shape[:-2], 1, 6))
        return np.concatenate([segments, one], axis=-2)

    def distances(self, segments: Array) -> Array:
        """Metres (..., n + m) between `pairs`, then those `faced`, of parts that are so placed."""
        (first, second), parts = self.pairs, self.faced[0]
        lead = segments.shape[:-2]
        between, to_boxes = np.empty((*lead, len(first))), np.empty((*lead, len(parts)))
        if first.size:
            one, other = (np.take(segments, index, axis=-2) for index in (first, second))
            _kernel.segment_distance(one, other, between)
        if parts.size:
            own = np.take(segments, parts, axis=-2)
            _kernel.box_clearance(own, stretched(self._boxes, (*to_boxes.shape, 7)), to_boxes)
        return np.concatenate([between, to_boxes], axis=-1) - self._widths


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
        """See `LimitGroup`; clearances are computed where all else is kept, which costs less."""
        inner, least = self._parted(ranges)
        kept = self.inner.keeps(inner, pose, joints)
        if not kept.any():
            return kept
        if kept.ndim and np.shape(joints)[:-1] == pose.position.shape[:-1]:
            clear = self._is_clear(least, pose[kept], np.asarray(joints)[kept])
            kept[kept] = clear
            return kept
        return np.asarray(kept & self._is_clear(least, pose, joints))

    def _is_clear(self, least: Array, pose: Pose, joints: Array) -> Mask:
        clear = self.clearance.values(pose, joints) >= least
        return np.asarray(np.logical_and.reduce(clear, axis=-1))

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
        is_checked = found in (first, count) or self._is_free(least, paths, found, met)
        return (found if is_checked else count), met

    def _first_clear(self, least: Array, paths: BrakingPaths, met: Array) -> int:
        """The largest of the twists with a path that meets nothing, by bisection; or how many."""
        if self._is_free(least, paths, 0, met):
            return 0
        blocked, free = 0, len(paths.twists) - 1
        if free == 0 or not self._is_free(least, paths, free, met):
            return len(paths.twists)
        while free - blocked > 1:
            middle = (blocked + free) // 2
            if self._is_free(least, paths, middle, met):
                free = middle
            else:
                blocked = middle
        return free

    def _is_free(self, least: Array, paths: BrakingPaths, index: int, met: Array) -> bool:
        """Whether a path meets nothing; where it does, as `braking_path`, is put into `met`."""
        poses = paths.poses(paths.twists[index])
        own = paths.of_platform(poses)
        joints = self.kinematics.inverse_or_nan(own, paths.joints)
        clear = self._is_clear(least, own, joints)
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
