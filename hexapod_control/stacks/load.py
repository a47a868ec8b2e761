"""From a machine file of kind `stack` to a machine that the nodes can use."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from hexapod_control import load
from hexapod_control.bodies import stack_bodies
from hexapod_control.stacks.inverse import MOST_SECTIONS
from hexapod_control.stacks.kinematics import StackKinematics
from hexapod_control.stacks.limits import constraints_of
from hexapod_control.stacks.stack import Stack
from manipulator.config import PLACE_MM, SIZE_MM, TURN_DEG, build, key, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import counted
from manipulator.machine import Kind, Machine, MachineFile
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.platform_jogger import PlatformJogger


@dataclass(frozen=True)
class NextConfig:
    """Where the next section's base, or the end, is in a platform's frame."""

    xyz_mm: tuple[float, float, float] = quantity(
        *PLACE_MM, 'from the platform', default=(0.0, 0.0, 0.0)
    )
    rpy_deg: tuple[float, float, float] = quantity(
        *TURN_DEG, 'roll, pitch, yaw', default=(0.0, 0.0, 0.0)
    )

    @property
    def pose(self) -> Pose:
        """T_platform_next."""
        x, y, z = (1e-3 * value for value in self.xyz_mm)
        return Pose.from_xyz_rpy((x, y, z), [math.radians(angle) for angle in self.rpy_deg])


@dataclass(frozen=True)
class SectionConfig:
    """One platform; kind, geometry, limits and dynamics are those of a machine file of its kind.

    They are there, too, where they were taken from the file that `machine` names.
    """

    machine: str = key(
        'a shipped name, or a path from the folder of this file: gives the next four',
        default='',
    )
    kind: str = key('of platform', default='')
    geometry: dict[str, Any] = key('as in a file of this kind', default_factory=dict)
    limits: dict[str, Any] = key('as in a file of this kind', default_factory=dict)
    dynamics: dict[str, Any] | None = key('as in a file of this kind', default=None)
    next: NextConfig = key(
        'the next section’s base, or the end, on this platform', default_factory=NextConfig
    )

    def __post_init__(self) -> None:
        """Raises ConfigError for what is missing."""
        missing = [name for name in ('kind', 'geometry', 'limits') if not getattr(self, name)]
        if missing:
            raise ConfigError([f'{name}: missing' for name in missing])


@dataclass(frozen=True)
class StackConfig:
    """The `geometry` section: from the ground up."""

    sections: tuple[SectionConfig, ...] = key('platforms, from the ground up')

    def __post_init__(self) -> None:
        """Raises ConfigError for too few or too many sections."""
        check_count(len(self.sections))


def check_count(count: int) -> None:
    """Raises ConfigError for sections that are no stack, or more than the kernel knows."""
    if not 2 <= count <= MOST_SECTIONS:
        sections = counted(count, 'section')
        raise ConfigError([f'sections: {sections}, a stack has 2 to {MOST_SECTIONS}'])


@dataclass(frozen=True)
class StackLimitsConfig:
    """The `limits` section: each section has its own limits beside its geometry."""

    characteristic_length_mm: float = quantity(
        *SIZE_MM, 'scales rotations in distances between poses of the end'
    )


def stack(machine_file: MachineFile) -> Machine:
    """The machine of one file; ConfigError names each fault with its section, from 0."""
    return KIND.build(machine_file)(machine_file)


def _stack(config: StackConfig, limits: StackLimitsConfig, machine_file: MachineFile) -> Machine:
    sections = _sections(config, machine_file)
    _check_units(sections)
    transforms = tuple(section.next.pose for section in config.sections)
    kinematics = StackKinematics(
        Stack(sections, transforms), limits.characteristic_length_mm * 1e-3
    )
    motion = MotionLimits.from_config(machine_file.motion, kinematics.joint_unit)
    _check_motion(motion, kinematics)
    return Machine(
        kinematics,
        constraints_of(kinematics),
        motion,
        make_jogger=PlatformJogger,
        make_bodies=partial(stack_bodies, kinematics),
    )


KIND: Kind[Callable[[MachineFile], Machine]] = Kind(
    StackConfig, StackLimitsConfig, lambda config, limits: partial(_stack, config, limits)
)


def section_files(machine_file: MachineFile) -> tuple[MachineFile, ...]:
    """Each section as a machine file of its own kind, without servos; ConfigError as `stack`."""
    return tuple(
        _machine_file(section, machine_file)
        for section in build(StackConfig, machine_file.geometry, 'geometry').sections
    )


def _check_units(sections: tuple[Machine, ...]) -> None:
    first, *others = (machine.kinematics.joint_unit for machine in sections)
    for i, unit in enumerate(others, 1):
        if unit != first:
            raise ConfigError(
                [
                    f'geometry.sections[{i}]: its joints are in {unit}, those of sections[0] in '
                    f'{first}; all joints of a machine have one unit'
                ]
            )


def _check_motion(motion: MotionLimits, kinematics: StackKinematics) -> None:
    """Raises ConfigError for limits of six joints alone."""
    unit, count = 'mm' if kinematics.joint_unit == 'm' else 'deg', len(kinematics.joint_names)
    limits = {
        f'joint_speed_{unit}_s': motion.joint.speed,
        f'joint_acceleration_{unit}_s2': motion.joint.acceleration,
    }
    problems = [
        f'motion.{name}: has {limit.size} entries, a stack of {count} joints needs one number'
        for name, limit in limits.items()
        if limit.shape
    ]
    if problems:
        raise ConfigError(problems)


def _sections(config: StackConfig, machine_file: MachineFile) -> tuple[Machine, ...]:
    """Each section as a machine; those that are described alike are one.

    Limits of the joints' speed are the stack's, and in the unit of all joints.
    """
    made: list[tuple[MachineFile, Machine]] = []
    sections, problems = [], []
    motion = replace(
        machine_file.motion,
        joint_speed_deg_s=None,
        joint_acceleration_deg_s2=None,
        joint_speed_mm_s=None,
        joint_acceleration_mm_s2=None,
    )
    for i, section in enumerate(config.sections):
        file = _machine_file(section, replace(machine_file, motion=motion))
        machine = next((m for other, m in made if other == file), None)
        if machine is None:
            try:
                machine = load.hexapod(file)
            except ConfigError as error:
                problems += [_of_section(i, section, problem) for problem in error.problems]
                continue
            made.append((file, machine))
        sections.append(machine)
    if problems:
        raise ConfigError(problems)
    return tuple(sections)


def _of_section(index: int, section: SectionConfig, problem: str) -> str:
    source = f' (of {section.machine})' if section.machine else ''
    return f'geometry.sections[{index}].{problem}{source}'


def _machine_file(section: SectionConfig, whole: MachineFile) -> MachineFile:
    return MachineFile(
        section.kind,
        section.geometry,
        section.limits,
        whole.motion,
        driver='topic',
        dynamics=section.dynamics,
    )
