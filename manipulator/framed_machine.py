"""A machine as driven by the pose of its pivot in the user's work frame.

It stays a machine like any other, so that plans, limits and maps need not know; turns are then
about the pivot, and moves are straight for it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array, Mask
from manipulator.frames import NO_TOOL, Frames
from manipulator.kinematics import ForwardSolution, Kinematics
from manipulator.limits.constraints import Constraints
from manipulator.limits.limit import Bounds, BrakingPaths, LimitGroup, LimitOf, Search
from manipulator.links import Link, Stroke
from manipulator.machine import Machine
from manipulator.pose import Pose

PATH_ROTATION = slice(5, 14)
"""Of a `braking_path` of kernel/braking.h."""


def in_frames(machine: Machine, frames: Frames) -> Machine:
    """The machine as driven by T_work_pivot; with the same kinematics when frames are plain."""
    held = frames.T_platform_pivot.position if frames.tool != NO_TOOL else np.zeros(3)
    machine = machine.holding(held)
    if frames.are_plain:
        return replace(machine, frames=frames)
    kinematics = FramedKinematics(machine.kinematics, frames)
    limits, framed = [], dict[LimitGroup, FramedGroup]()
    constraints = machine.constraints
    for limit, (group, _) in zip(constraints.limits, constraints.places, strict=True):
        if group is not None:
            framed.setdefault(group, FramedGroup(group, frames))
        limits.append(FramedLimit(limit, frames, None if group is None else framed[group]))
    constraints = Constraints(tuple(limits))
    return replace(machine, kinematics=kinematics, constraints=constraints, frames=frames)


@dataclass(frozen=True)
class FramedKinematics:
    """A Kinematics whose poses are those of the pivot in the work frame."""

    inner: Kinematics
    frames: Frames

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Those of the machine."""
        return self.inner.joint_names

    @property
    def joint_unit(self) -> str:
        """That of the machine."""
        return self.inner.joint_unit

    @property
    def characteristic_length(self) -> float:
        """That of the machine."""
        return self.inner.characteristic_length

    @property
    def home(self) -> Pose:
        """The pivot's pose when the machine is at home."""
        return self.frames.pivot(self.inner.home)

    @property
    def is_explicit(self) -> bool:
        """That of the machine."""
        return self.inner.is_explicit

    @property
    def joins_branches(self) -> bool:
        """That of the machine."""
        return self.inner.joins_branches

    def inverse(self, pose: Pose, near: Array | None = None) -> Array:
        """See `Kinematics`."""
        return self.inner.inverse(self.frames.platform(pose), near)

    def inverse_or_nan(self, pose: Pose, near: Array | None = None) -> Array:
        """See `Kinematics`."""
        return self.inner.inverse_or_nan(self.frames.platform(pose), near)

    def inverse_along(self, poses: Pose, near: Array) -> Array:
        """See `Kinematics`."""
        return self.inner.inverse_along(self.frames.platform(poses), near)

    def forward(self, joints: Array, near: Pose | None = None) -> ForwardSolution:
        """See `Kinematics`."""
        start = None if near is None else self.frames.platform(near)
        solution = self.inner.forward(joints, start)
        return replace(solution, pose=self.frames.pivot(solution.pose))

    def forward_along(self, joints: Array, near: Pose) -> Pose:
        """See `Kinematics`."""
        return self.frames.pivot(self.inner.forward_along(joints, self.frames.platform(near)))

    def jacobian(self, pose: Pose, joints: Array) -> Array:
        """The twist of the pivot in work axes: v + ω × r, then both turned."""
        platform = self.frames.platform(pose)
        arm = platform.rotation @ self.frames.T_platform_pivot.position
        rows = self.inner.jacobian(platform, joints)
        linear = rows[..., :3, :] - so3.skew(arm) @ rows[..., 3:, :]
        to_work = self.frames.T_base_work.rotation.T
        return np.concatenate([to_work @ linear, to_work @ rows[..., 3:, :]], axis=-2)

    def skeleton(self, pose: Pose, joints: Array) -> tuple[Stroke, ...]:
        """That of the machine, in the base frame."""
        return self.inner.skeleton(self.frames.platform(pose), joints)

    def links(self, pose: Pose, joints: Array) -> tuple[Link, ...]:
        """Those of the machine, in the base frame."""
        return self.inner.links(self.frames.platform(pose), joints)

    def sigma_min(self, pose: Pose, joints: Array) -> Array:
        """The machine's own margin: it does not depend on the user's frames."""
        return self.inner.sigma_min(self.frames.platform(pose), joints)


@dataclass(frozen=True, eq=False)
class FramedGroup:
    """A group of limits of the machine, evaluated with poses of the pivot in the work frame.

    The group itself knows pivots that have the platform's axes: poses are turned to those.
    """

    inner: LimitGroup
    frames: Frames

    @property
    def of_pose(self) -> slice:
        """See `LimitGroup`: the platform's own."""
        return self.inner.of_pose

    def limited_values(self, pose: Pose, joints: Array) -> Array:
        """See `LimitGroup`."""
        return self.inner.limited_values(self.frames.platform(pose), joints)

    def ranges(self, bounds: Sequence[Bounds]) -> Array:
        """See `LimitGroup`."""
        return self.inner.ranges(bounds)

    def keeps(self, ranges: Array, pose: Pose, joints: Array) -> Mask:
        """See `LimitGroup`."""
        return self.inner.keeps(ranges, self.frames.platform(pose), joints)

    def descended(self, search: Search, bounds: Sequence[Bounds], start: Pose) -> Pose:
        """See `LimitGroup`: the same search with the pivot's poses in the base frame."""
        T_base_work, turn = self.frames.T_base_work, self._pivot_turn.inverse()
        pivot = self.frames.T_platform_pivot.position
        of_pivot = replace(search, target=T_base_work @ search.target @ turn, pivot=pivot)
        end = self.inner.descended(of_pivot, bounds, T_base_work @ start @ turn)
        return T_base_work.inverse() @ end @ self._pivot_turn

    def first_free_path(self, ranges: Array, paths: BrakingPaths) -> tuple[int, Array]:
        """See `LimitGroup`."""
        work, pivot = self.frames.T_base_work, self.frames.T_platform_pivot.position
        frame = np.concatenate([work.position, work.rotation.ravel(), pivot])
        turned = replace(paths, frame=frame, pose=paths.pose @ self._pivot_turn.inverse())
        free, found = self.inner.first_free_path(ranges, turned)
        rotations = found[:free, PATH_ROTATION]
        rotations[:] = (rotations.reshape(-1, 3, 3) @ self._pivot_turn.rotation).reshape(-1, 9)
        return free, found

    @property
    def _pivot_turn(self) -> Pose:
        return Pose.unchecked(np.zeros(3), self.frames.T_platform_pivot.rotation)


@dataclass(frozen=True, eq=False)
class FramedLimit(LimitOf):
    """A limit of the machine, for poses of the pivot in the work frame."""

    frames: Frames
    framed_group: FramedGroup | None = None

    @property
    def group(self) -> LimitGroup | None:
        """That of the limit, evaluated likewise."""
        return self.framed_group

    @property
    def low(self) -> Array:
        """Those of the limit."""
        return self.inner.low

    @property
    def high(self) -> Array:
        """Those of the limit."""
        return self.inner.high

    def values(self, pose: Pose, joints: Array) -> Array:
        """The limited values (..., k), by the platform's pose."""
        return self.inner.values(self.frames.platform(pose), joints)
