"""From a machine file to its MuJoCo model: one function a kind of machine."""

from collections.abc import Callable
from functools import partial
from typing import Any

from arm_control.geometry import ArmLimits
from hexapod_control.geometry import LEGS
from hexarm.simulation.arm_model import arm_model
from hexarm.simulation.drives import Drives, pushing, servo_speeds, turning
from hexarm.simulation.dynamics_config import (
    SCHEMAS,
    ArmDynamicsConfig,
    LinearDynamicsConfig,
    RotaryDynamicsConfig,
)
from hexarm.simulation.linear_model import linear_model
from hexarm.simulation.rigid_body import Mechanism
from hexarm.simulation.rotary_model import rotary_model
from manipulator.config import build
from manipulator.errors import ConfigError
from manipulator.kinematics import Kinematics
from manipulator.machine import MachineFile

Dynamics = RotaryDynamicsConfig | LinearDynamicsConfig | ArmDynamicsConfig


def dynamics_of(machine_file: MachineFile, payload_g: float | None = None) -> Dynamics:
    """The section `dynamics`, checked; payload_g in place of its own payload.

    Raises ConfigError where it is missing or wrong, or a payload is negative or not finite.
    """
    if machine_file.dynamics is None:
        raise ConfigError(
            ['dynamics: missing, the model needs masses and drives (see docs/physics.md)']
        )
    section: dict[str, Any] = dict(machine_file.dynamics)
    if payload_g is not None and isinstance(section.get('payload'), dict):
        section['payload'] = {**section['payload'], 'mass_g': float(payload_g)}
    return build(SCHEMAS[machine_file.kind], section, 'dynamics')


def drives_of(dynamics: Dynamics, machine_file: MachineFile) -> Drives:
    """The drives of a machine, in the order of its joints.

    An arm without servos of ours has drives as fast as its joints may turn.
    """
    servos = machine_file.servos
    if isinstance(dynamics, LinearDynamicsConfig):
        return pushing(dynamics.drive, LEGS, servos)
    if isinstance(dynamics, RotaryDynamicsConfig):
        return turning((dynamics.drive,) * LEGS, servo_speeds(servos, LEGS))
    drives = tuple(link.drive for link in dynamics.links)
    if machine_file.driver == 'topic':
        return turning(
            drives, build(ArmLimits, machine_file.limits, 'limits').joint_limits().speed
        )
    return turning(drives, servo_speeds(servos, len(drives)))


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
    dynamics = dynamics_of(machine_file, payload_g)
    drives = drives_of(dynamics, machine_file)
    if torque is not None:
        drives = drives.stronger(torque)
    make = _MODELS[type(dynamics)](machine_file.limits)
    return make(name, kinematics, dynamics, drives)


def _crank_platform(limits: dict[str, Any]) -> Callable[..., Mechanism]:
    return partial(rotary_model, minimum_height=1e-3 * limits['minimum_height_mm'])


_MODELS: dict[type[Dynamics], Callable[[dict[str, Any]], Callable[..., Mechanism]]] = {
    RotaryDynamicsConfig: _crank_platform,
    LinearDynamicsConfig: lambda limits: linear_model,
    ArmDynamicsConfig: lambda limits: arm_model,
}
"""What makes the model of a kind of machine, from the limits of its machine file."""
