"""All limits of a stack's sections at once: each section keeps its own, on its own base."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hexapod_control.geometry import LEGS
from hexapod_control.platform_limits import VALUES
from hexapod_control.stacks.kinematics import StackKinematics
from manipulator.analysis.slope import nearest_point
from manipulator.arrays import Array, Mask, frozen
from manipulator.errors import ManipulatorError
from manipulator.limits.constraints import Constraints
from manipulator.limits.limit import Bounds, BrakingPaths, Grouped, GroupedLimit, Limit, Search
from manipulator.limits.machine_limits import JointRange
from manipulator.limits.task_space import QUANTITIES, pose_values
from manipulator.pose import Pose

A_LIMIT, A_SPEED, AN_ACCELERATION = 1, 2, 3
"""What limits a braking path: `obstacle` of kernel/braking.h."""
ROUNDING = 1e-9
TRIED = 2
"""Braking paths that are looked at as a whole where the largest part is blocked."""
DIFFERENCE = 1e-6
"""Of the characteristic length, for slopes of margins."""
SETTLED = 1e-9
MOST_CUTS = 30


@dataclass(frozen=True, eq=False)
class StackLimits:
    """The `LimitGroup` of a stack: the joints (6n), each section's values, those of the end."""

    kinematics: StackKinematics

    @property
    def of_pose(self) -> slice:
        """See `LimitGroup`: of the end."""
        first = (LEGS + VALUES) * len(self.kinematics.platforms)
        return slice(first, first + len(QUANTITIES))

    def limited_values(self, pose: Pose, joints: Array) -> Array:
        """See `LimitGroup`; the joints alone say where the sections are."""
        shape = np.broadcast_shapes(np.shape(joints)[:-1], pose.position.shape[:-1])
        given = np.broadcast_to(joints, (*shape, np.shape(joints)[-1]))
        parts = [given]
        platforms = zip(
            self.kinematics.platforms, self.kinematics.sections_or_nan(given), strict=True
        )
        for i, (platform, at) in enumerate(platforms):
            own = given[..., LEGS * i : LEGS * (i + 1)]
            parts.append(platform.limits.limited_values(at, own))
        of_end = pose_values(pose, self.kinematics.home.rotation)
        parts.append(np.broadcast_to(of_end, (*shape, len(QUANTITIES))))
        return np.concatenate(parts, axis=-1)

    def ranges(self, bounds: Sequence[Bounds]) -> Array:
        """See `LimitGroup`: least and most, (2, K) ±∞ where there is none."""
        count = self.of_pose.stop
        ranges = np.stack([np.full(count, -np.inf), np.full(count, np.inf)])
        for columns, low, high in bounds:
            ranges[0, columns] = np.maximum(ranges[0, columns], low)
            ranges[1, columns] = np.minimum(ranges[1, columns], high)
        return ranges

    def keeps(self, ranges: Array, pose: Pose, joints: Array) -> Mask:
        """See `LimitGroup`; a value that does not exist is outside."""
        values = self.limited_values(pose, joints)
        free = np.isinf(ranges).all(axis=0)
        inside = (values >= ranges[0]) & (values <= ranges[1])
        return np.asarray((inside | free).all(axis=-1) & np.isfinite(joints).all(axis=-1))

    def descended(self, search: Search, bounds: Sequence[Bounds], start: Pose) -> Pose:
        """See `LimitGroup`: steps to the nearest pose within the limits as they are about here."""
        ranges, pose = self.ranges(bounds), _pivot_of(start, -search.pivot)
        length = self.kinematics.characteristic_length
        for _ in range(search.most_steps):
            slack, normals = self._margins(ranges, pose, length)
            target = self._offset(search, pose, length)
            step, weights = nearest_point(target, normals, slack - search.clearance)
            if np.isnan(weights).any() or np.abs(step).max() < SETTLED * length:
                break
            moved = self._advanced(search, ranges, pose, step, length)
            if moved is None:
                break
            pose = moved
        return _pivot_of(pose, search.pivot)

    def first_free_path(self, ranges: Array, paths: BrakingPaths) -> tuple[int, Array]:
        """See `LimitGroup`; each path as kernel/braking.h judges it.

        Paths are for the parts of one twist, from the largest. The largest that ends within the
        limits is bisected for; where neither it nor the next is free, none is tried any more.
        """
        count = len(paths.twists)
        found = np.zeros((count, 14 + len(paths.joints)))
        if self._put_path(ranges, paths, paths.twists[0], found[0]):
            return 0, found
        blocked, free = 0, count - 1
        if count == 1 or not self._put_end(ranges, paths, paths.twists[free], found[free]):
            return count, found
        while free - blocked > 1:
            middle = (blocked + free) // 2
            if self._put_end(ranges, paths, paths.twists[middle], found[middle]):
                free = middle
            else:
                blocked = middle
        for k in range(free, min(free + TRIED, count)):
            if self._put_path(ranges, paths, paths.twists[k], found[k]):
                return k, found
        return count, found

    def _put_end(self, ranges: Array, paths: BrakingPaths, twist: Array, found: Array) -> bool:
        """Whether a path ends within the limits; where not, that is put into `found`."""
        gone = _seconds(twist, paths.bounds)[-1:]
        return self._joints_within(ranges, paths, gone[:, None] * twist, found) is not None

    def _joints_within(
        self, ranges: Array, paths: BrakingPaths, steps: Array, found: Array
    ) -> Array | None:
        """The joints (k, n) after steps (k, 6); None where one breaks a limit: see `found`."""
        poses = paths.pose.moved(steps)
        own = _of_platform(poses, paths.frame)
        joints = self.kinematics.inverse_along(own, paths.joints)
        kept = self.keeps(ranges, own, joints)
        if kept.all():
            return joints
        first = int(np.argmin(kept))
        at, turned = poses.position[first], poses.rotation[first].ravel()
        found[:] = np.concatenate([[A_LIMIT, 0.0], at, turned, joints[first]])
        return None

    def _put_path(self, ranges: Array, paths: BrakingPaths, twist: Array, found: Array) -> bool:
        """Whether a path is free; what limits it, and where, is put into `found`."""
        if not self._put_end(ranges, paths, twist, found):
            return False
        dt = float(paths.bounds[0])
        steps = _seconds(twist, paths.bounds)[:, None] * twist
        joints = self._joints_within(ranges, paths, steps, found)
        if joints is None:
            return False
        rates = np.diff(np.vstack([paths.joints, joints]), axis=0) / dt
        pulls = np.diff(np.vstack([paths.rates, rates]), axis=0) / dt
        count = len(paths.joints)
        for kind, used, bound in (
            (A_SPEED, rates, paths.bounds[3 : 3 + count]),
            (AN_ACCELERATION, pulls, paths.bounds[3 + count :]),
        ):
            part = np.abs(used).max(axis=0) / bound
            if part.max() > 1.0:
                found[:2] = kind, int(np.argmax(part))
                return False
        return True

    def _margins(self, ranges: Array, pose: Pose, length: float) -> tuple[Array, Array]:
        """Distances (k,) to the limits in metres to first order, and the unit normals (k, 6)."""
        metres = np.array([1.0] * 3 + [length] * 3)
        steps = DIFFERENCE * length * np.vstack([np.zeros((1, 6)), np.eye(6), -np.eye(6)])
        poses = pose.moved(steps / metres)
        values = self.limited_values(poses, self.kinematics.inverse_or_nan(poses))
        margins = np.concatenate([values - ranges[0], ranges[1] - values], axis=-1)
        margins = margins[:, np.isfinite(margins).all(axis=0)]
        slopes = (margins[1:7] - margins[7:]).T / (2.0 * DIFFERENCE * length)
        steepness = np.sqrt((slopes**2).sum(axis=1))
        felt = steepness > 0.0
        return margins[0, felt] / steepness[felt], slopes[felt] / steepness[felt, None]

    def _offset(self, search: Search, pose: Pose, length: float) -> Array:
        """From the pivot's pose to the target's, in metres (6,)."""
        twist = _pivot_of(pose, search.pivot).twist_to(search.target)
        return np.concatenate([twist[:3], length * twist[3:]])

    def _advanced(
        self, search: Search, ranges: Array, pose: Pose, step: Array, length: float
    ) -> Pose | None:
        """The pose along the step, as far as it is inside and nearer; None for nowhere."""
        metres = np.array([1.0] * 3 + [length] * 3)
        before = np.linalg.norm(self._offset(search, pose, length))
        pivot = _pivot_of(pose, search.pivot)
        for cut in range(MOST_CUTS):
            trial = _pivot_of(pivot.moved(0.5**cut * step / metres), -search.pivot)
            inside = self.keeps(ranges, trial, self.kinematics.inverse_or_nan(trial))
            if inside and np.linalg.norm(self._offset(search, trial, length)) < before:
                return trial
        return None


def constraints_of(kinematics: StackKinematics) -> Constraints:
    """Every section's limits, the joint ranges of all of them together, first."""
    group, sections = StackLimits(kinematics), kinematics.stack.sections
    ranges, others = [], list[Limit]()
    for i, machine in enumerate(sections):
        for limit in machine.constraints.limits:
            owners = tuple(f'section {i + 1} {owner}'.rstrip() for owner in limit.owners)
            if isinstance(limit, JointRange):
                ranges.append((limit, owners))
                continue
            if not isinstance(limit, Grouped):
                raise ManipulatorError(f'section {i + 1}: {limit.quantity} is in no group')
            first = LEGS * len(sections) + VALUES * i
            columns = slice(first + limit.columns.start, first + limit.columns.stop)
            others.append(
                GroupedLimit(
                    group, columns, limit.quantity, limit.unit, owners, limit.low, limit.high
                )
            )
    first_range = ranges[0][0]
    joints = JointRange(
        np.concatenate([limit.low for limit, _ in ranges]),
        np.concatenate([limit.high for limit, _ in ranges]),
        tuple(owner for _, owners in ranges for owner in owners),
        first_range.quantity,
        first_range.unit,
        group=group,
        columns=slice(0, LEGS * len(sections)),
    )
    return Constraints((joints, *others))


def _seconds(twist: Array, bounds: Array) -> Array:
    """For how long at full twist a path has gone at its ticks: one tick, then braking to rest."""
    linear, angular = np.linalg.norm(twist[:3]) / bounds[1], np.linalg.norm(twist[3:]) / bounds[2]
    ticks = int(np.ceil(max(max(linear, angular) / bounds[0] - ROUNDING, 1.0)))
    gone: Array = bounds[0] * np.cumsum(1.0 - np.arange(ticks + 1) / ticks)
    return gone


def _of_platform(poses: Pose, frame: Array | None) -> Pose:
    """The platform's poses (N,) in the base frame, of the pivot's in the work frame."""
    if frame is None:
        return poses
    T_base_work = Pose(frame[:3], frame[3:12].reshape(3, 3))
    return _pivot_of(T_base_work @ poses, -frame[12:])


def _pivot_of(pose: Pose, offset: Array) -> Pose:
    """The pose displaced by an offset (3,) in its own axes."""
    return pose @ Pose(frozen(offset), np.eye(3))
