"""Platforms stacked on platforms: the outlook of Lapikov et al. 2014, docs/kinematics.md, 9.

The end's pose is the product T₁ X₁ T₂ X₂ … Tₙ Xₙ of the sections' poses Tᵢ and the fixed
transforms Xᵢ from each platform to the next section's base, or to the end.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from hexapod_control.workspace import axis_range
from manipulator.analysis.free_paths import is_connected
from manipulator.analysis.readings import read_limits
from manipulator.arrays import Array, frozen
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.machine import Machine
from manipulator.pose import Pose

SPARE = 0.01
"""The part of every margin at home that is kept where the limits decide."""

STIFFNESSES = (1e1, 1e3, 1e5)
STEP, SETTLED = 1e-6, 1e-14


@dataclass(frozen=True, eq=False)
class StackPose:
    """Every section's pose on its own base, their joints (n, 6), and the end's pose.

    distance is the norm over all sections of their twists from home, relative to their ranges.
    """

    sections: tuple[Pose, ...]
    joints: Array
    end: Pose
    distance: float


@dataclass(frozen=True, eq=False)
class Stack:
    """Sections from the ground up; transforms[i] is T_platform_next of section i, in metres.

    ranges (n, 6) are half of what each section can move along and about each axis from home, the
    units in which distances from home are measured. Raises ConfigError for an empty stack, or
    another number of transforms.
    """

    sections: tuple[Machine, ...]
    transforms: tuple[Pose, ...]
    ranges: Array = field(init=False)
    home: Pose = field(init=False)
    home_margins: tuple[Array, ...] = field(init=False)

    def __post_init__(self) -> None:
        """Measures the ranges of the sections."""
        if not self.sections or len(self.sections) != len(self.transforms):
            raise ConfigError(
                [f'{len(self.sections)} sections and {len(self.transforms)} transforms of a stack']
            )
        object.__setattr__(self, 'sections', tuple(self.sections))
        object.__setattr__(self, 'transforms', tuple(self.transforms))
        found = {id(m): [np.ptp(axis_range(m, a)) / 2 for a in range(6)] for m in self.sections}
        object.__setattr__(self, 'ranges', frozen([found[id(m)] for m in self.sections]))
        homes = [m.kinematics.home for m in self.sections]
        margins = [
            read_limits(m, home).margins for m, home in zip(self.sections, homes, strict=True)
        ]
        object.__setattr__(self, 'home', self.end_of(homes))
        object.__setattr__(self, 'home_margins', tuple(frozen(m) for m in margins))

    def end_of(self, sections: Sequence[Pose]) -> Pose:
        """The end's pose for all sections' poses (...)."""
        end = Pose.identity()
        for pose, transform in zip(sections, self.transforms, strict=True):
            end = end @ pose @ transform
        return end

    def forward(self, joints: Array, near: Sequence[Pose] | None = None) -> StackPose:
        """The stack for joints (n, 6), in radians or metres by section; `near` as `Kinematics`.

        Raises InvalidInput for another shape, NoSolution naming the section.
        """
        given = np.asarray(joints, dtype=np.float64)
        if given.shape[:1] != (len(self.sections),):
            raise InvalidInput(f'joints of shape {given.shape} for {len(self.sections)} sections')
        poses = []
        for i, machine in enumerate(self.sections):
            start = None if near is None else near[i]
            try:
                poses.append(machine.kinematics.forward(given[i], start).pose)
            except NoSolution as error:
                raise NoSolution(f'section {i + 1}: {error}') from error
        return StackPose(tuple(poses), frozen(given), self.end_of(poses), self.distance(poses))

    def inverse(self, end: Pose) -> StackPose:
        """Of all ways to put the end to one pose, the one that stays nearest to all homes.

        That is the least sum over sections and axes of (twist from home / range)², within every
        section's limits. Found from home by a descent: a local minimum. Raises Unreachable,
        naming section and limit, where none is found, or no free path leads there from home.
        """
        free = np.zeros(6 * (len(self.sections) - 1))
        free = _descended(lambda x: self._relative(self._poses(x, end)), free)
        for stiffness in STIFFNESSES:
            if self._is_inside(self._poses(free, end)):
                break
            free = _descended(partial(self._pressed, end=end, stiffness=stiffness), free)
        return self._checked(self._poses(free, end))

    def distance(self, sections: Sequence[Pose]) -> float:
        """How far one pose of each section is from home, relative to the ranges."""
        return float(np.linalg.norm(self._relative(sections)))

    def _poses(self, free: Array, end: Pose) -> list[Pose]:
        """All sections: the last closes the gap that the relative twists (..., 6(n − 1)) leave."""
        twists = free.reshape(*free.shape[:-1], -1, 6)
        poses, base = [], Pose.identity()
        for i, (machine, transform) in enumerate(
            zip(self.sections[:-1], self.transforms[:-1], strict=True)
        ):
            pose = machine.kinematics.home.moved(twists[..., i, :] * self.ranges[i])
            poses.append(pose)
            base = base @ pose @ transform
        return [*poses, base.inverse() @ end @ self.transforms[-1].inverse()]

    def _relative(self, sections: Sequence[Pose]) -> Array:
        """Twists from home by range (..., 6n)."""
        parts = [
            machine.kinematics.home.twist_to(pose) / self.ranges[i]
            for i, (machine, pose) in enumerate(zip(self.sections, sections, strict=True))
        ]
        return np.concatenate(parts, axis=-1)

    def _pressed(self, free: Array, end: Pose, stiffness: float) -> Array:
        """The distances, and what is lacking in every limit's margin, relative to that at home."""
        poses = self._poses(free, end)
        residuals = [self._relative(poses)]
        for machine, pose, at_home in zip(self.sections, poses, self.home_margins, strict=True):
            bounded = np.isfinite(at_home) & (at_home > 0.0)
            margins = read_limits(machine, pose).margins[..., bounded] / at_home[bounded]
            lack = np.sqrt(stiffness) * np.maximum(SPARE - margins, 0.0)
            residuals.append(np.nan_to_num(lack, nan=0.0))
        return np.concatenate(residuals, axis=-1)

    def _is_inside(self, poses: Sequence[Pose]) -> bool:
        return all(
            bool(m.constraints.admits(pose, m.kinematics.inverse_or_nan(pose)))
            for m, pose in zip(self.sections, poses, strict=True)
        )

    def _checked(self, poses: list[Pose]) -> StackPose:
        """The stack with its joints; Unreachable where a section cannot be so."""
        joints = []
        for i, (machine, pose) in enumerate(zip(self.sections, poses, strict=True)):
            try:
                joints.append(machine.kinematics.inverse(pose))
                machine.constraints.check(pose, joints[-1])
            except Unreachable as error:
                raise Unreachable(f'section {i + 1}: {error}', error.leg) from error
            if not is_connected(machine, pose):
                raise Unreachable(f'section {i + 1}: no way found from home within the limits')
        return StackPose(
            tuple(poses), frozen(np.stack(joints)), self.end_of(poses), self.distance(poses)
        )


def _descended(residuals: Callable[[Array], Array], start: Array) -> Array:
    """Where Σ residuals² has a local minimum, from `start` (n,); slopes by differences.

    residuals maps (..., n) to (..., m), all variables being of about the same size.
    """
    from scipy.optimize import least_squares  # noqa: PLC0415 (50 MB: for who asks)

    if not start.size:
        return start
    steps = STEP * np.eye(start.size)

    def slopes(x: Array) -> Array:
        return np.asarray((residuals(x + steps) - residuals(x)).T / STEP)

    found = least_squares(residuals, start, slopes, method='lm', ftol=SETTLED, xtol=SETTLED)
    return np.asarray(found.x)
