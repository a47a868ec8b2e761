"""`hexarm simulate MACHINE`: a periodic motion in MuJoCo, with the sensors of Prokopovich 2019."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hexarm import machines
from hexarm.cli.accuracy import common_error
from hexarm.cli.answers import Answer, add_machine, answering, picture_file
from hexarm.cli.export import modelled
from hexarm.cli.simulated import Experiment, in_words, summary
from hexarm.simulation.compensation import Compensation
from hexarm.simulation.limit_search import (
    FREQUENCY,
    PAPER_AMPLITUDE,
    corners_out,
    poses_of,
    share_in_reach,
)
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.rigid_body import payload
from hexarm.simulation.static_load import check_holds, static_load
from manipulator.analysis.accuracy import JointErrors
from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.planning.cycle import Cycle

if TYPE_CHECKING:
    from hexarm.simulation.experiment import Recording
    from hexarm.simulation.sensors import Series
    from hexarm.simulation.simulation import Simulation

LONGEST_SECONDS = 120.0
SIX = ('X', 'Y', 'Z', 'R', 'P', 'Y')
LAWS = ('independent', 'common')
NOISE_SEED = 1


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('simulate')
    add_machine(parser)
    _add_motion(parser)
    parser.add_argument('--payload', type=float, metavar='G', help="grams, for the machine file's")
    parser.add_argument('--torque', type=float, metavar='NM', help='of each drive, N·m or N')
    parser.add_argument(
        '--compensate', action=argparse.BooleanOptionalAction, default=None,
        help='compensate the static deflection of the drives (default: see the machine file)',
    )  # fmt: skip
    parser.add_argument(
        '--noise', type=float, metavar='A',
        help='servo errors within ±A, rad or m, new every 20 ms: runs with and without',
    )  # fmt: skip
    parser.add_argument(
        '--noise-law', choices=LAWS, default=LAWS[0],
        help='one signal for each servo (default), or one for all, as each turns',
    )  # fmt: skip
    parser.add_argument(
        '--picture', type=picture_file, metavar='FILE', help='plots of the sensors'
    )
    parser.add_argument('--data', type=Path, metavar='FILE.csv', help='all sensors over time')
    parser.add_argument('--animation', type=Path, metavar='FILE.gif', help='the machine moving')
    parser.set_defaults(run=answering(answer))


def _add_motion(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--amplitude', nargs=6, type=float, metavar=SIX,
        help='metres and radians (default: Prokopovich 2019, fig. 12)',
    )  # fmt: skip
    parser.add_argument(
        '--frequency', nargs='+', type=float, default=[FREQUENCY], metavar='HZ',
        help=f'of all axes, or six (default {FREQUENCY})',
    )  # fmt: skip
    parser.add_argument(
        '--phase', nargs=6, type=float, default=[0.0] * 6, metavar=SIX,
        help='radians (default 0: in phase)',
    )  # fmt: skip
    parser.add_argument(
        '--periods', type=float, default=2.0, metavar='N',
        help='of the motion, after which all axes repeat (default 2)',
    )  # fmt: skip


def answer(arguments: argparse.Namespace) -> Answer:
    """The sensors and the largest of each, the following error, and what was out of reach."""
    from hexarm.simulation.experiment import (  # noqa: PLC0415 (needs mujoco)
        noisy,
        position_rms,
        run,
        unshifted,
    )
    from hexarm.simulation.sensors import Series  # noqa: PLC0415
    from hexarm.simulation.simulation import Simulation  # noqa: PLC0415

    this = prepared(arguments)
    kinematics, mechanism = this.machine.kinematics, this.mechanism
    simulation = Simulation(mechanism, kinematics.home, kinematics.inverse(kinematics.home))
    shift = this.compensation if this.is_compensated else unshifted
    recording = run(simulation, kinematics, this.cycle, arguments.periods, shift)
    numbers = summary(this, recording)
    if this.noise is not None:
        simulation.reset(kinematics.home, kinematics.inverse(kinematics.home))
        errors = noisy(shift, this.noise, np.random.default_rng(NOISE_SEED))
        other = run(simulation, kinematics, this.cycle, arguments.periods, errors)
        numbers['noise_position_rms'] = position_rms(recording, other)
    lines = in_words(this, numbers)
    series = Series.of(recording, mechanism.joints, this.load)
    if arguments.json:
        numbers['series'] = series.for_programs()
    return numbers, [*lines, *saved(arguments, this, recording, simulation, series)]


def saved(
    arguments: argparse.Namespace,
    this: Experiment,
    recording: 'Recording',
    simulation: 'Simulation',
    series: 'Series',
) -> list[str]:
    """The files that were asked for, written; their names."""
    written = []
    if arguments.data is not None:
        if arguments.data.suffix != '.csv':
            raise InvalidInput(f'--data {arguments.data}: the name must end in .csv')
        series.write_csv(arguments.data)
        written.append(arguments.data)
    if arguments.picture is not None:
        from hexarm.pictures.simulation import draw  # noqa: PLC0415 (needs matplotlib)

        name = Path(arguments.machine).stem
        draw(recording, this.mechanism, arguments.picture, this.load, name)
        written.append(arguments.picture)
    if arguments.animation is not None:
        from hexarm.pictures.animation import animate  # noqa: PLC0415 (needs matplotlib, pillow)

        animate(simulation, this.machine.kinematics, recording, arguments.animation)
        written.append(arguments.animation)
    return [str(path) for path in written]


def prepared(arguments: argparse.Namespace) -> Experiment:
    """The experiment within reach; Stalls where the servos cannot even hold its poses."""
    if arguments.torque is not None and not 0 < arguments.torque < np.inf:
        raise InvalidInput(f'--torque {arguments.torque:g} is not above 0')
    machine, file = machines.load(arguments.machine), machines.read(arguments.machine)
    mechanism = modelled(arguments.machine, arguments.payload, arguments.torque)
    asked = requested_cycle(machine, arguments)
    part = share_in_reach(machine, asked)
    cycle = replace(asked, amplitude=part * asked.amplitude)
    dynamics = dynamics_of(file, arguments.payload)
    load = static_load(machine.kinematics, dynamics)
    poses = poses_of(cycle)
    joints = machine.kinematics.inverse(poses)
    check_holds(load, mechanism.drives, machine.kinematics, poses, joints)
    chosen = dynamics.compensation if arguments.compensate is None else arguments.compensate
    return Experiment(
        machine, mechanism, cycle, part, corners_out(machine, asked.amplitude[0]),
        Compensation(load, mechanism.drives), chosen, payload(dynamics.payload),
        servo_noise(arguments, len(mechanism.joints)),
    )  # fmt: skip


def requested_cycle(machine: Machine, arguments: argparse.Namespace) -> Cycle:
    """The cycle about home; InvalidInput for frequencies that are neither one nor six."""
    frequency = np.array(arguments.frequency)
    if len(frequency) not in (1, 6):
        raise InvalidInput(f'--frequency has {len(frequency)} numbers, needs one or six')
    if not (frequency > 0).all():
        raise InvalidInput(f'--frequency {frequency.min():g} Hz is not above 0')
    amplitude = np.array(arguments.amplitude or PAPER_AMPLITUDE)
    cycle = Cycle(
        machine.kinematics.home, amplitude, np.broadcast_to(frequency, 6), arguments.phase
    )
    seconds = arguments.periods * cycle.checked_duration
    if not seconds <= LONGEST_SECONDS:
        raise InvalidInput(
            f'{arguments.periods:g} periods of {cycle.checked_duration:g} s are not within '
            f'{LONGEST_SECONDS:g} s'
        )
    return cycle


def servo_noise(arguments: argparse.Namespace, joints: int) -> JointErrors | None:
    """The errors of the servos by the law requested, None without --noise."""
    noise = arguments.noise
    if noise is None:
        return None
    if not 0.0 < noise < 1.0:
        raise InvalidInput(f'--noise {noise:g} is outside (0, 1)')
    if arguments.noise_law == 'common':
        return common_error(machines.read(arguments.machine), noise, joints)
    return JointErrors.of(joints, noise=noise)
