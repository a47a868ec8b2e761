"""Which poses the sections of a stack take: the rule of docs/kinematics.md, section 9.

The descent is in kernel/stack.c.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hexapod_control.platform_limits import PlatformLimits, lowest_and_highest
from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.machine import Machine
from manipulator.pose import Pose

MOST_SECTIONS = 6
"""As in kernel/stack.h."""

GIVEN, FROM_HOME, ALONG = 0.0, 1.0, 2.0
"""`stack_start` of kernel/stack.h."""

SPARE = 0.1
"""The part of every margin at home below which a limit is felt."""
STIFFNESS = 1e3
"""What lacks in a margin, by that at home and squared, costs this much in (9.3)."""


@dataclass(frozen=True, eq=False)
class NearestToHome:
    """Sections, the transforms after each, and half their ranges (n, 6): what the rule needs.

    numbers: `struct stack` of kernel/stack.h.
    """

    sections: tuple[Machine, ...]
    transforms: tuple[Pose, ...]
    ranges: Array
    numbers: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Lays out what the kernel is given."""
        parts = [
            _section_numbers(*section)
            for section in zip(self.sections, self.transforms, self.ranges, strict=True)
        ]
        unused = np.zeros((MOST_SECTIONS - len(parts)) * len(parts[0]))
        numbers = np.concatenate([[len(parts), SPARE, STIFFNESS], *parts, unused])
        object.__setattr__(self, 'numbers', frozen(numbers))

    def sections_at(self, end: Pose, start: Sequence[Pose] | None = None) -> tuple[Pose, ...]:
        """All sections' poses (...) that put the end there, by a descent from `start` (or home).

        A local minimum of the rule's sum. The end is always met exactly; what the sections'
        limits say of the poses is for `Constraints`. NaN where the descent does not settle.
        """
        return self._solved(self.numbers, end, start)

    def _solved(
        self, numbers: Array, end: Pose, start: Sequence[Pose] | None, begin: float = GIVEN
    ) -> tuple[Pose, ...]:
        shape = end.position.shape[:-1]
        free = np.zeros((*shape, 6 * MOST_SECTIONS))
        if start is not None:
            free[..., : 6 * len(self.sections)] = self.relative(start)
        positions = np.empty((*shape, MOST_SECTIONS, 3))
        rotations = np.empty((*shape, MOST_SECTIONS, 3, 3))
        position, rotation = stretched(end.position, (*shape, 3)), end.rotation
        begins = np.array([FROM_HOME if start is None else begin])
        settled = np.empty(shape)
        _kernel.stack_sections(
            numbers, begins, position, stretched(rotation, (*shape, 3, 3)), free,
            positions, rotations, settled,
        )  # fmt: skip
        positions[settled == 0.0], rotations[settled == 0.0] = np.nan, np.nan
        return tuple(
            Pose.unchecked(positions[..., i, :].copy(), rotations[..., i, :, :].copy())
            for i in range(len(self.sections))
        )

    def sections_along(self, ends: Pose, start: Sequence[Pose]) -> tuple[Pose, ...]:
        """As `sections_at` for ends (N,) in a row, each from the one before, the first from start.

        start is one pose of each section. NaN from the first that does not settle.
        """
        return self._solved(self.numbers, ends, start, ALONG)

    def unlimited_at(self, end: Pose) -> tuple[Pose, ...]:
        """As `sections_at` for an end (): the least of (9.2), whatever the limits."""
        numbers = self.numbers.copy()
        numbers[2] = 0.0
        return self._solved(numbers, end, None)

    def relative(self, sections: Sequence[Pose]) -> Array:
        """The twists from home by range (..., 6n)."""
        parts = [
            machine.kinematics.home.twist_to(pose) / self.ranges[i]
            for i, (machine, pose) in enumerate(zip(self.sections, sections, strict=True))
        ]
        return np.concatenate(parts, axis=-1)


def _section_numbers(machine: Machine, transform: Pose, ranges: Array) -> Array:
    """`struct stack_section`; the machine is a platform by itself, in its own frames."""
    (group, _), home = machine.constraints.checks[0], machine.kinematics.home
    assert isinstance(group, PlatformLimits)
    low, high = lowest_and_highest(machine.constraints.bounds[0])
    values = group.limited_values(home, machine.kinematics.inverse(home))
    margins = np.stack([values - low, high - values])
    felt = np.where(np.isfinite(margins) & (margins > 0.0), margins, 0.0)
    bounds = np.nan_to_num(np.stack([low, high]), posinf=0.0, neginf=0.0)
    return np.concatenate(
        [
            group.parameters,
            *(x.ravel() for p in (home, transform) for x in (p.position, p.rotation)),
            ranges,
            bounds.ravel(),
            felt.ravel(),
        ]
    )
