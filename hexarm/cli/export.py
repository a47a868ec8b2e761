"""`hexarm mjcf` and `hexarm urdf`: a machine as a MuJoCo model, an arm as URDF."""

import argparse
import sys
from pathlib import Path

from arm_control.arm import SerialArm
from arm_control.urdf import urdf
from hexarm import machines
from hexarm.cli.answers import Answer, add_machine, answering
from hexarm.link_meshes import meshes_of
from hexarm.simulation.arm_model import with_meshes
from hexarm.simulation.dynamics_config import ArmDynamicsConfig
from hexarm.simulation.model import mechanism
from hexarm.simulation.rigid_body import Mechanism
from manipulator.config import build
from manipulator.errors import InvalidInput, Refused
from manipulator.formatting import counted, reason
from manipulator.machine import MachineFile


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares both subcommands."""
    _add_mjcf(commands)
    _add_urdf(commands)


def _add_mjcf(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    parser = commands.add_parser('mjcf')
    add_machine(parser)
    parser.add_argument('--output', type=Path, metavar='FILE', help='instead of the terminal')
    parser.set_defaults(run=answering(_mjcf))


def _mjcf(arguments: argparse.Namespace) -> Answer:
    """The model, or where it was written; only what assembles at home is."""
    from hexarm.simulation.simulation import Simulation  # noqa: PLC0415 (needs mujoco)

    model, kinematics = modelled(arguments.machine), machines.load(arguments.machine).kinematics
    meshes, faults = meshes_of(arguments.machine)
    if isinstance(kinematics, SerialArm) and meshes:
        model = with_meshes(model, kinematics, [mesh.file if mesh else None for mesh in meshes])
    simulation = Simulation(model, kinematics.home, kinematics.inverse(kinematics.home))
    if arguments.output is None:
        for fault in faults:
            print(fault, file=sys.stderr)
        return {'mjcf': model.xml}, [model.xml.rstrip('\n')]
    try:
        arguments.output.write_text(model.xml, encoding='utf-8')
    except OSError as error:
        raise InvalidInput(f'cannot write {arguments.output}: {reason(error)}') from error
    counts = {
        'freedoms': int(simulation.model.nv),
        'closures': len(model.closures),
        'drives': len(model.joints),
    }
    words = ', '.join(f'{count} {name}' for name, count in counts.items())
    lines = [f'{arguments.output}: {words}', *faults]
    return {'output': str(arguments.output), **counts}, lines


def modelled(
    name_or_path: str, payload_g: float | None = None, torque: float | None = None
) -> Mechanism:
    """The model of a machine file, in the base's frame; ConfigError as `mechanism`."""
    machine_file = machines.read(name_or_path)
    kinematics = machines.load(name_or_path).kinematics
    stem = machines.find(name_or_path).stem
    return mechanism(stem, machine_file, kinematics, payload_g, torque)


THICKNESS = 0.06
"""Radius of a rod, in characteristic lengths, where the file has no section `dynamics`."""


def _add_urdf(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    parser = commands.add_parser('urdf')
    add_machine(parser)
    parser.add_argument('--output', type=Path, metavar='FILE', help='instead of the terminal')
    parser.set_defaults(run=answering(_urdf))


def _urdf(arguments: argparse.Namespace) -> Answer:
    """The document, or where it was written; Refused for a platform, whose legs are loops."""
    arm = machines.load(arguments.machine).kinematics
    if not isinstance(arm, SerialArm):
        raise Refused(
            f'{arguments.machine} is a parallel platform, and URDF has no closed loops: '
            f'hexarm mjcf {arguments.machine}'
        )
    radii, torques = _drawn(machines.read(arguments.machine), arm)
    text = urdf(machines.find(arguments.machine).stem, arm, radii, torques)
    if arguments.output is None:
        return {'urdf': text}, [text.rstrip('\n')]
    try:
        arguments.output.write_text(text, encoding='utf-8')
    except OSError as error:
        raise InvalidInput(f'cannot write {arguments.output}: {reason(error)}') from error
    joints = len(arm.joint_names)
    return {'output': str(arguments.output), 'joints': joints}, [
        f'{arguments.output}: {counted(joints, "joint")}'
    ]


def _drawn(machine_file: MachineFile, arm: SerialArm) -> tuple[list[float], list[float]]:
    """Radius (m) and torque (N m) of each joint; the torque is 0 where it is not given."""
    if machine_file.dynamics is None:
        count = len(arm.joint_names)
        return [THICKNESS * arm.characteristic_length] * count, [0.0] * count
    recorded = build(ArmDynamicsConfig, machine_file.dynamics, 'dynamics').links
    return [1e-3 * link.radius_mm for link in recorded], [
        link.drive.torque_n_m for link in recorded
    ]
