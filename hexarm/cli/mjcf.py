"""`hexarm mjcf MACHINE [--output FILE]`: a machine as a MuJoCo model."""

import argparse
from pathlib import Path

from hexarm import machines
from hexarm.cli.answers import Answer, add_machine, answering
from hexarm.simulation.model import mechanism
from hexarm.simulation.rigid_body import Mechanism
from manipulator.errors import InvalidInput
from manipulator.formatting import reason


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('mjcf', help='write a machine as a MuJoCo model')
    add_machine(parser)
    parser.add_argument('--output', type=Path, metavar='FILE', help='instead of the terminal')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """The model, or where it was written; only what assembles at home is."""
    from hexarm.simulation.simulation import Simulation  # noqa: PLC0415 (needs mujoco)

    model = modelled(arguments.machine)
    kinematics = machines.load(arguments.machine).kinematics
    simulation = Simulation(model, kinematics.home, kinematics.inverse(kinematics.home))
    if arguments.output is None:
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
    return {'output': str(arguments.output), **counts}, [f'{arguments.output}: {words}']


def modelled(
    name_or_path: str, payload_g: float | None = None, torque: float | None = None
) -> Mechanism:
    """The model of a machine file, in the base's frame; ConfigError as `mechanism`."""
    machine_file = machines.read(name_or_path)
    kinematics = machines.load(name_or_path).kinematics
    stem = machines.find(name_or_path).stem
    return mechanism(stem, machine_file, kinematics, payload_g, torque)
