"""From a machine file to its MuJoCo model: one function a kind of machine."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from arm_control.joint_limits import ArmLimits
from hexapod_control.geometry import LEGS
from hexapod_control.stacks.kinematics import StackKinematics
from hexapod_control.stacks.load import section_files
from hexarm.simulation.arm_model import arm_model
from hexarm.simulation.drives import Drives, pusher_speeds, pushing, servo_speeds, turning
from hexarm.simulation.dynamics_config import (
    SCHEMAS,
    ArmDynamicsConfig,
    CarriedConfig,
    Dynamics,
    LinearDynamicsConfig,
    RailDynamicsConfig,
    RotaryDynamicsConfig,
    StackDynamicsConfig,
)
from hexarm.simulation.linear_model import linear_model
from hexarm.simulation.rail_model import rail_model
from hexarm.simulation.rigid_body import Mechanism
from hexarm.simulation.rotary_model import rotary_model
from hexarm.simulation.stack_model import stack_model
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.kinematics import Kinematics
from manipulator.machine import MachineFile
from manipulator.motion_limits import MotionLimits


def dynamics_of(machine_file: MachineFile, payload_g: float | None = None) -> Dynamics:
    """The section `dynamics`, checked, with the first tool; payload_g in place of its own payload.

    Raises ConfigError where it is missing or wrong, or a payload is negative or not finite.
    """
    if machine_file.kind not in SCHEMAS:
        raise ConfigError(
            [f'kind: a {machine_file.kind} is not simulated, hexarm mjcf has its model']
        )
    if machine_file.dynamics is None:
        raise ConfigError(
            ['dynamics: missing, the model needs masses and drives (see docs/physics.md)']
        )
    section: dict[str, Any] = dict(machine_file.dynamics)
    if payload_g is not None and isinstance(section.get('payload'), dict):
        section['payload'] = {**section['payload'], 'mass_g': float(payload_g)}
    dynamics = build(SCHEMAS[machine_file.kind], section, 'dynamics')
    first = next(iter(machine_file.tools), None)
    if first is None or first.load[0] == 0.0:
        return dynamics
    own = dynamics.payload
    held = CarriedConfig(own.source, own.mass_g, own.radius_mm, own.height_mm, first)
    return replace(dynamics, payload=held)


def drives_of(dynamics: Dynamics, machine_file: MachineFile) -> Drives:
    """The drives of a machine, in the order of its joints.

    A machine without servos of ours has drives as fast as its joints may be.
    """
    servos, has_servos = machine_file.servos, machine_file.driver != 'topic'
    if isinstance(dynamics, ArmDynamicsConfig):
        drives = tuple(link.drive for link in dynamics.links)
        if has_servos:
            return turning(drives, servo_speeds(servos, len(drives)))
        limits = build(ArmLimits, machine_file.limits, 'limits').joint_limits()
        return turning(drives, limits.speed)
    unit = 'rad' if isinstance(dynamics, RotaryDynamicsConfig) else 'm'
    motion = MotionLimits.from_config(machine_file.motion, unit)
    fastest = np.broadcast_to(motion.joint.speed, LEGS)
    if isinstance(dynamics, RotaryDynamicsConfig):
        speeds = servo_speeds(servos, LEGS) if has_servos else fastest
        return turning((dynamics.drive,) * LEGS, speeds)
    return pushing(dynamics.drive, pusher_speeds(servos, LEGS) if has_servos else fastest)


def mechanism(
    name: str,
    machine_file: MachineFile,
    kinematics: Kinematics,
    payload_g: float | None = None,
    torque: float | None = None,
) -> Mechanism:
    """The model of one machine; kinematics is what its file makes, without frames of its own.

    payload_g replaces the file's payload, torque (N·m or N) its drives' effort. ConfigError as
    `dynamics_of`.
    """
    if isinstance(kinematics, StackKinematics):
        parts = _sections(machine_file, kinematics, payload_g, torque)
        own = build(StackDynamicsConfig, machine_file.dynamics or {}, 'dynamics')
        return stack_model(name, kinematics, parts, own.gravity)
    dynamics = dynamics_of(machine_file, payload_g)
    drives = drives_of(dynamics, machine_file)
    if torque is not None:
        drives = drives.stronger(torque)
    make = _MODELS[type(dynamics)](machine_file.limits)
    return make(name, kinematics, dynamics, drives)


def _sections(
    machine_file: MachineFile,
    kinematics: StackKinematics,
    payload_g: float | None,
    torque: float | None,
) -> tuple[Mechanism, ...]:
    """Of a stack; the payload is what its uppermost platform carries."""
    parts, last = [], len(kinematics.platforms) - 1
    files = zip(section_files(machine_file), kinematics.platforms, strict=True)
    for i, (file, platform) in enumerate(files):
        own = replace(
            file, driver=machine_file.driver, servos=machine_file.servos, link=machine_file.link
        )
        load = payload_g if i == last else 0.0
        own = replace(own, tools=machine_file.tools if i == last else ())
        try:
            parts.append(mechanism(f'section_{i + 1}', own, platform, load, torque))
        except ConfigError as error:
            problems = [f'geometry.sections[{i}].{problem}' for problem in error.problems]
            raise ConfigError(problems) from error
    return tuple(parts)


def _crank_platform(limits: dict[str, Any]) -> Callable[..., Mechanism]:
    return partial(rotary_model, minimum_height=1e-3 * limits['minimum_height_mm'])


_MODELS: dict[type[Dynamics], Callable[[dict[str, Any]], Callable[..., Mechanism]]] = {
    RotaryDynamicsConfig: _crank_platform,
    LinearDynamicsConfig: lambda limits: linear_model,
    RailDynamicsConfig: lambda limits: rail_model,
    ArmDynamicsConfig: lambda limits: arm_model,
}
"""What makes the model of a kind of machine, from the limits of its machine file."""
