"""Which poses the sections of a stack take: the rule of docs/kinematics.md, section 9.

The descent is in kernel/stack.c.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from manipulator import _kernel
from manipulator.arrays import Array, frozen, stretched
from manipulator.machine import Machine
from manipulator.pose import Pose

MOST_SECTIONS = 6
"""As in kernel/stack.h."""


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
            _section_numbers(machine.kinematics.home, transform, ranges)
            for machine, transform, ranges in zip(
                self.sections, self.transforms, self.ranges, strict=True
            )
        ]
        unused = np.zeros((MOST_SECTIONS - len(parts)) * len(parts[0]))
        numbers = np.concatenate([[len(parts)], *parts, unused])
        object.__setattr__(self, 'numbers', frozen(numbers))

    def sections_at(
        self, end: Pose, start: Sequence[Pose] | None = None, is_row: bool = False
    ) -> tuple[Pose, ...]:
        """All sections' poses (...) that put the end (...) there, by a descent from start or home.

        A minimum of (9.2). The end is always met exactly; what the sections' limits say of the
        poses is for `Constraints`. NaN where the descent does not settle. With is_row, ends (N,)
        begin each where the one before came to, and only the first at start; NaN from the first
        that does not settle.
        """
        shape = end.position.shape[:-1]
        free = np.zeros((*shape, 6 * MOST_SECTIONS))
        if start is not None:
            free[..., : 6 * len(self.sections)] = self.relative(start)
        positions = np.empty((*shape, MOST_SECTIONS, 3))
        rotations = np.empty((*shape, MOST_SECTIONS, 3, 3))
        settled = np.empty(shape)
        _kernel.stack_sections(
            self.numbers, np.array([float(is_row)]), stretched(end.position, (*shape, 3)),
            stretched(end.rotation, (*shape, 3, 3)), free, positions, rotations, settled,
        )  # fmt: skip
        positions[settled == 0.0], rotations[settled == 0.0] = np.nan, np.nan
        return tuple(
            Pose.unchecked(positions[..., i, :].copy(), rotations[..., i, :, :].copy())
            for i in range(len(self.sections))
        )

    def relative(self, sections: Sequence[Pose]) -> Array:
        """The twists from home by range (..., 6n)."""
        parts = [
            machine.kinematics.home.twist_to(pose) / self.ranges[i]
            for i, (machine, pose) in enumerate(zip(self.sections, sections, strict=True))
        ]
        return np.concatenate(parts, axis=-1)


def _section_numbers(home: Pose, transform: Pose, ranges: Array) -> Array:
    """`struct stack_section`."""
    poses = [x.ravel() for p in (home, transform) for x in (p.position, p.rotation)]
    return np.concatenate([*poses, ranges])
