"""From a machine file's sections to a serial arm that the nodes can use."""

from dataclasses import replace

import numpy as np

from arm_control.arm import SerialArm
from arm_control.arm_jogger import ArmJogger
from arm_control.geometry import FORMS, placed
from arm_control.joint_limits import ArmLimits
from arm_control.resolved_rate import ResolvedRate
from manipulator.config import build, build_both
from manipulator.errors import ConfigError
from manipulator.machine import Machine, MachineFile
from manipulator.motion_limits import MotionLimits
from manipulator.words import shown

KIND = 'serial_arm'


def arm(machine_file: MachineFile) -> Machine:
    """The machine of one file; its kinematics is a `SerialArm`. ConfigError names each fault."""
    jog = jogging(machine_file)
    return Machine(
        jog.arm,
        jog.arm.limits.constraints(),
        jog.motion,
        make_jogger=lambda machine: _jogger(jog, machine),
    )


def _jogger(jog: ResolvedRate, machine: Machine) -> ArmJogger:
    slides = machine.jog_singularity == 'slide'
    return ArmJogger(replace(jog, slides=slides), machine.frames)


def serial_arm(machine_file: MachineFile) -> SerialArm:
    """The kinematics and joint limits of one file."""
    if machine_file.kind != KIND:
        raise ConfigError([f'kind: {shown(machine_file.kind)} is not {KIND!r}'])
    told = [form for key, form in FORMS.items() if key in machine_file.geometry]
    if len(told) != 1:
        raise ConfigError([f'geometry: needs one of the keys {list(FORMS)}, has {len(told)}'])
    geometry, limits = build_both(
        (told[0], machine_file.geometry, 'geometry'), (ArmLimits, machine_file.limits, 'limits')
    )
    length = limits.characteristic_length_mm * 1e-3
    rest = np.radians(geometry.home_deg)
    return SerialArm(placed(geometry.chain()), limits.joint_limits(), length, rest)


def jogging(machine_file: MachineFile) -> ResolvedRate:
    """The resolved-rate step of one file's arm, within its joint and motion limits."""
    limits = build(ArmLimits, machine_file.limits, 'limits')
    kinematics = serial_arm(machine_file)
    motion = MotionLimits.from_config(machine_file.motion)
    own = kinematics.limits
    motion = replace(motion, joint=motion.joint.tightened(own.speed, own.acceleration))
    return ResolvedRate(kinematics, motion, limits.damping_onset)
