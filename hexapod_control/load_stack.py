"""From a machine file of kind `stack` to a machine that the nodes can use."""

import math
from dataclasses import dataclass
from typing import Any

from hexapod_control import load
from hexapod_control.stack import Stack
from hexapod_control.stack_inverse import MOST_SECTIONS
from hexapod_control.stack_kinematics import StackKinematics
from hexapod_control.stack_limits import constraints_of
from manipulator.config import build, build_both, quantity
from manipulator.errors import ConfigError
from manipulator.formatting import counted
from manipulator.machine import Machine, MachineFile
from manipulator.motion_limits import MotionLimits
from manipulator.pose import Pose
from manipulator.teleop.platform_jogger import PlatformJogger


@dataclass(frozen=True)
class NextConfig:
    """Where the next section's base, or the end, is in a platform's frame."""

    xyz_mm: tuple[float, float, float] = quantity(-3000, 3000, default=(0.0, 0.0, 0.0))
    rpy_deg: tuple[float, float, float] = quantity(-360, 360, default=(0.0, 0.0, 0.0))

    @property
    def pose(self) -> Pose:
        """T_platform_next."""
        x, y, z = (1e-3 * value for value in self.xyz_mm)
        return Pose.from_xyz_rpy((x, y, z), [math.radians(angle) for angle in self.rpy_deg])


@dataclass(frozen=True)
class SectionConfig:
    """One platform; geometry, limits and dynamics are those of a machine file of its kind.

    machine: the file that they were taken from, '' where the section has them itself.
    """

    kind: str
    geometry: dict[str, Any]
    limits: dict[str, Any]
    next: NextConfig = NextConfig()
    dynamics: dict[str, Any] | None = None
    machine: str = ''


@dataclass(frozen=True)
class StackConfig:
    """The `geometry` section: from the ground up."""

    sections: tuple[SectionConfig, ...]

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

    characteristic_length_mm: float = quantity(1, 3000)


def stack(machine_file: MachineFile) -> Machine:
    """The machine of one file; ConfigError names each fault with its section, from 0."""
    config, limits = build_both(
        (StackConfig, machine_file.geometry, 'geometry'),
        (StackLimitsConfig, machine_file.limits, 'limits'),
    )
    sections = _sections(config, machine_file)
    _check_units(sections)
    transforms = tuple(section.next.pose for section in config.sections)
    kinematics = StackKinematics(
        Stack(sections, transforms), limits.characteristic_length_mm * 1e-3
    )
    motion = MotionLimits.from_config(machine_file.motion)
    return Machine(kinematics, constraints_of(kinematics), motion, make_jogger=PlatformJogger)


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


def _sections(config: StackConfig, machine_file: MachineFile) -> tuple[Machine, ...]:
    """Each section as a machine; those that are described alike are one."""
    made: list[tuple[MachineFile, Machine]] = []
    sections, problems = [], []
    for i, section in enumerate(config.sections):
        file = _machine_file(section, machine_file)
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
        servos={},
        link={},
        dynamics=section.dynamics,
    )
