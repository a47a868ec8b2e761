"""Platforms stacked on platforms: the outlook of Lapikov et al. 2014, docs/kinematics.md, 9.

The end's pose is the product T₁ X₁ T₂ X₂ … Tₙ Xₙ of the sections' poses Tᵢ and the fixed
transforms Xᵢ from each platform to the next section's base, or to the end.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hexapod_control.stacks.inverse import NearestToHome
from hexapod_control.workspace import axis_range
from manipulator.analysis.free_paths import is_connected
from manipulator.arrays import Array, frozen
from manipulator.errors import ConfigError, InvalidInput, NoSolution, Unreachable
from manipulator.machine import Machine
from manipulator.pose import Pose

AXES = ('along x', 'along y', 'along z', 'about x', 'about y', 'about z')
LEAST_RANGE = 1e-6
"""Metres or radians."""
FAR = 'the sections find no common way to this pose of the end: it is far from all they reach'


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
    rule: NearestToHome = field(init=False)

    def __post_init__(self) -> None:
        """Measures the ranges of the sections; ConfigError for one that cannot move from home."""
        if not self.sections or len(self.sections) != len(self.transforms):
            raise ConfigError(
                [f'{len(self.sections)} sections and {len(self.transforms)} transforms of a stack']
            )
        object.__setattr__(self, 'sections', tuple(self.sections))
        object.__setattr__(self, 'transforms', tuple(self.transforms))
        found = {id(m): [np.ptp(axis_range(m, a)) / 2 for a in range(6)] for m in self.sections}
        object.__setattr__(self, 'ranges', frozen([found[id(m)] for m in self.sections]))
        _check_ranges(self.ranges)
        homes = [m.kinematics.home for m in self.sections]
        object.__setattr__(self, 'home', self.end_of(homes))
        rule = NearestToHome(self.sections, self.transforms, self.ranges)
        object.__setattr__(self, 'rule', rule)

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

        That is the least sum over sections and axes of (twist from home / range)². Raises
        Unreachable, naming section and limit, where a section cannot be so: other shares might
        still reach the pose. So it is, too, where no free path from home leads there.
        """
        sections = self.rule.sections_at(end)
        if np.isnan(sections[-1].position).any():
            raise Unreachable(FAR)
        return self._checked(sections)

    def distance(self, sections: Sequence[Pose]) -> float:
        """How far one pose of each section is from home, relative to the ranges."""
        return float(np.linalg.norm(self.rule.relative(sections)))

    def _checked(self, poses: tuple[Pose, ...]) -> StackPose:
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
        return StackPose(poses, frozen(np.stack(joints)), self.end_of(poses), self.distance(poses))


def _check_ranges(ranges: Array) -> None:
    """The rule divides by them."""
    for section, axis in np.argwhere(ranges < LEAST_RANGE):
        raise ConfigError(
            [f'section {section + 1} cannot move from home {AXES[axis]} within its limits']
        )
