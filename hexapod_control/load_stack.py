"""From a machine file of kind `stack` to a machine that the nodes can use."""

import math
from dataclasses import dataclass
from typing import Any

from hexapod_control import load
from hexapod_control.stack import Stack
from hexapod_control.stack_inverse import MOST_SECTIONS
from hexapod_control.stack_kinematics import StackKinematics
from hexapod_control.stack_limits import constraints_of
from manipulator.config import build_both, quantity
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
    """One platform; geometry and limits are those of a machine file of its kind."""

    kind: str
    geometry: dict[str, Any]
    limits: dict[str, Any]
    next: NextConfig = NextConfig()


@dataclass(frozen=True)
class StackConfig:
    """The `geometry` section: from the ground up."""

    sections: tuple[SectionConfig, ...]

    def __post_init__(self) -> None:
        """Raises ConfigError for no sections, or more than the kernel knows."""
        count = len(self.sections)
        if not 1 <= count <= MOST_SECTIONS:
            sections = counted(count, 'section')
            raise ConfigError([f'sections: {sections}, needs 1 to {MOST_SECTIONS}'])


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
    units = [machine.kinematics.joint_unit for machine in sections]
    if len(set(units)) > 1:
        raise ConfigError(
            [f'geometry.sections: their joints are in {units}, one machine has one unit']
        )
    transforms = tuple(section.next.pose for section in config.sections)
    kinematics = StackKinematics(
        Stack(sections, transforms), limits.characteristic_length_mm * 1e-3
    )
    motion = MotionLimits.from_config(machine_file.motion)
    return Machine(kinematics, constraints_of(kinematics), motion, make_jogger=PlatformJogger)


def _sections(config: StackConfig, machine_file: MachineFile) -> tuple[Machine, ...]:
    """Each section as a machine; those that are described alike are one."""
    made: list[tuple[SectionConfig, Machine]] = []
    sections, problems = [], []
    for i, section in enumerate(config.sections):
        alike = (m for c, m in made if (c.kind, c.geometry, c.limits) == _content(section))
        machine = next(alike, None)
        if machine is None:
            try:
                machine = load.hexapod(_machine_file(section, machine_file))
            except ConfigError as error:
                problems += [f'geometry.sections[{i}].{problem}' for problem in error.problems]
                continue
            made.append((section, machine))
        sections.append(machine)
    if problems:
        raise ConfigError(problems)
    return tuple(sections)


def _content(section: SectionConfig) -> tuple[str, dict[str, Any], dict[str, Any]]:
    return section.kind, section.geometry, section.limits


def _machine_file(section: SectionConfig, whole: MachineFile) -> MachineFile:
    return MachineFile(
        section.kind, section.geometry, section.limits, whole.motion, servos={}, link={}
    )
