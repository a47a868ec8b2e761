"""Which poses one set of joints can mean: every assembly mode, judged by the machine's limits."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from hexapod_control.assembly_modes import modes_of
from hexapod_control.linear import LinearPlatform
from hexapod_control.parallel_platform import ParallelPlatform
from hexapod_control.stacks.kinematics import StackKinematics
from manipulator.arrays import Array
from manipulator.errors import NoSolution
from manipulator.framed_machine import FramedKinematics
from manipulator.kinematics import Kinematics
from manipulator.limits.limit import Violation
from manipulator.machine import Machine
from manipulator.pose import Pose

SAME = 1e-6


@dataclass(frozen=True)
class Mode:
    """A pose that has the joints asked for, its singularity margin and every limit it breaks.

    `is_reachable` when it breaks none and is on home's side of every singularity, of both types:
    the machine could have come there from home. Whether limits leave a way is not asked.
    """

    pose: Pose
    sigma_min: float
    violations: tuple[Violation, ...]
    is_reachable: bool


@dataclass(frozen=True)
class Modes:
    """All modes, the highest first; `is_complete` when none can be missing."""

    modes: tuple[Mode, ...]
    is_complete: bool

    @property
    def that_fit(self) -> tuple[Mode, ...]:
        """The modes that the machine can be in: more than one, and joints alone do not tell."""
        return tuple(mode for mode in self.modes if mode.is_reachable)

    def other_than(self, pose: Pose) -> tuple[Mode, ...]:
        """The modes that are not `pose`, to a micrometre and a microradian."""
        return tuple(m for m in self.modes if np.abs(pose.twist_to(m.pose)).max() > SAME)


def all_modes(machine: Machine, joints: Array) -> Modes:
    """Every pose with joints (6,); a serial machine's joints have but one.

    Raises NoSolution for joints that are not six finite numbers, or fix no pose, and for stacks.
    """
    poses, is_complete = _poses(machine.kinematics, joints)
    modes = (_judged(machine, pose, joints, at_home) for pose, at_home in poses)
    return Modes(tuple(modes), is_complete)


def _poses(kinematics: Kinematics, joints: Array) -> tuple[list[tuple[Pose, bool]], bool]:
    """Every pose, whether it is on home's side of every singularity; whether none is missing."""
    if isinstance(kinematics, FramedKinematics):
        poses, is_complete = _poses(kinematics.inner, joints)
        return [(kinematics.frames.pivot(pose), side) for pose, side in poses], is_complete
    if isinstance(kinematics, StackKinematics):
        raise NoSolution(
            'each section of a stack has assembly modes of its own, which are not combined'
        )
    if not isinstance(kinematics, ParallelPlatform):
        return [(kinematics.forward(joints).pose, True)], True
    found = modes_of(kinematics, joints)
    modes, is_complete = found.poses, found.is_complete
    if isinstance(kinematics, LinearPlatform) and kinematics.geometry.screw_lead != 0.0:
        modes = _with_screws(kinematics, joints, modes)
        is_complete = is_complete and len(modes) == len(found.poses)
    sides = [bool(kinematics.is_as_at_home(pose, joints)) for pose in modes]
    return list(zip(modes, sides, strict=True)), is_complete


def _with_screws(
    kinematics: LinearPlatform, joints: Array, poses: tuple[Pose, ...]
) -> tuple[Pose, ...]:
    """The modes near those of legs as long as their joints, where Newton's method finds others."""
    found: list[Pose] = []
    for pose in poses:
        with suppress(NoSolution):
            there = kinematics.forward(joints, pose).pose
            if all(np.abs(there.twist_to(other)).max() > SAME for other in found):
                found.append(there)
    return tuple(found)


def _judged(machine: Machine, pose: Pose, joints: Array, is_on_home_side: bool) -> Mode:
    violations = tuple(machine.constraints.violations(pose, joints))
    margin = float(machine.kinematics.sigma_min(pose, joints))
    return Mode(pose, margin, violations, is_on_home_side and not violations)
