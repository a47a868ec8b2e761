"""`hexarm simulate MACHINE`: a periodic motion in MuJoCo, with the sensors of Prokopovich 2019."""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hexarm import machines
from hexarm.cli.answers import Answer, add_machine, answering, picture_file
from hexarm.cli.export import modelled
from hexarm.simulation.compensation import Compensation
from hexarm.simulation.limit_search import (
    PAPER_AMPLITUDE,
    corners_out,
    in_phase,
    poses_of,
    share_in_reach,
)
from hexarm.simulation.model import dynamics_of
from hexarm.simulation.rigid_body import Mechanism
from hexarm.simulation.static_load import check_holds, static_load
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.machine import Machine
from manipulator.trajectory.cycle import Cycle

FREQUENCY = 0.884
"""Hertz at which the paper's amplitudes, in phase, reach 50 mm/s."""
LONGEST_SECONDS = 120.0
KG_CM = 0.0980665
G = 9.80665


@dataclass(frozen=True)
class Experiment:
    """A machine, its model, and the cycle that it is to do: `part` of the requested one.

    corners_out is how many of the 64 poses with every amplitude at + or − are out of reach.
    """

    machine: Machine
    mechanism: Mechanism
    cycle: Cycle
    part: float
    corners_out: int
    compensation: Compensation
    is_compensated: bool


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('simulate', help='a periodic motion as rigid bodies with servos')
    add_machine(parser)
    parser.add_argument(
        '--amplitude', nargs=6, type=float, metavar=('X', 'Y', 'Z', 'R', 'P', 'Y'),
        help='metres and radians, in phase (default: Prokopovich 2019, fig. 12)',
    )  # fmt: skip
    parser.add_argument(
        '--frequency', type=float, default=FREQUENCY, metavar='HZ', help='default 0.884'
    )
    parser.add_argument('--periods', type=float, default=2.0, metavar='N', help='default 2')
    parser.add_argument('--payload', type=float, metavar='G', help="grams, for the machine file's")
    parser.add_argument('--torque', type=float, metavar='NM', help='of each drive, N·m or N')
    parser.add_argument(
        '--compensate', action=argparse.BooleanOptionalAction, default=None,
        help='compensate the static deflection of the drives (default: see the machine file)',
    )  # fmt: skip
    parser.add_argument(
        '--picture', type=picture_file, metavar='FILE', help='plots of the sensors'
    )
    parser.add_argument('--animation', type=Path, metavar='FILE.gif', help='the machine moving')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """The largest of each sensor, the following error, and what of the motion was out of reach."""
    from hexarm.simulation.experiment import run, unshifted  # noqa: PLC0415 (needs mujoco)
    from hexarm.simulation.simulation import Simulation  # noqa: PLC0415

    if not 0 < arguments.periods / max(arguments.frequency, 1e-9) <= LONGEST_SECONDS:
        raise InvalidInput(
            f'{arguments.periods:g} periods at {arguments.frequency:g} Hz are not within '
            f'{LONGEST_SECONDS:g} s'
        )
    if arguments.torque is not None and not 0 < arguments.torque < np.inf:
        raise InvalidInput(f'--torque {arguments.torque:g} is not above 0')
    this = prepared(arguments)
    kinematics = this.machine.kinematics
    simulation = Simulation(this.mechanism, kinematics.home, kinematics.inverse(kinematics.home))
    shift = this.compensation if this.is_compensated else unshifted
    recording = run(simulation, kinematics, this.cycle, arguments.periods, shift)
    numbers = summary(this, recording)
    lines = in_words(this, numbers)
    if arguments.picture is not None:
        from hexarm.pictures.simulation import draw  # noqa: PLC0415 (needs matplotlib)

        draw(recording, this.mechanism, arguments.picture)
        lines.append(str(arguments.picture))
    if arguments.animation is not None:
        from hexarm.pictures.animation import animate  # noqa: PLC0415 (needs matplotlib, pillow)

        animate(simulation, kinematics, recording, arguments.animation)
        lines.append(str(arguments.animation))
    return numbers, lines


def prepared(arguments: argparse.Namespace) -> Experiment:
    """The experiment within reach; Stalls where the servos cannot even hold its poses."""
    machine, file = machines.load(arguments.machine), machines.read(arguments.machine)
    mechanism = modelled(arguments.machine, arguments.payload, arguments.torque)
    home = machine.kinematics.home
    amplitude = np.array(arguments.amplitude or PAPER_AMPLITUDE)
    cycle = in_phase(home, amplitude, arguments.frequency)
    part = share_in_reach(machine, cycle)
    cycle = replace(cycle, amplitude=part * cycle.amplitude)
    poses = poses_of(cycle)
    dynamics = dynamics_of(file, arguments.payload)
    load = static_load(machine.kinematics, dynamics)
    joints = machine.kinematics.inverse(poses)
    check_holds(load, mechanism.drives, mechanism.joints, poses, joints)
    chosen = dynamics.compensation if arguments.compensate is None else arguments.compensate
    out = corners_out(machine, amplitude)
    compensation = Compensation(load, mechanism.drives)
    return Experiment(machine, mechanism, cycle, part, out, compensation, chosen)


def summary(this: Experiment, recording: Any) -> dict[str, Any]:
    """Numbers for programs: SI units and radians."""
    errors = recording.errors
    speed = np.linalg.norm(recording.twists[:, :3], axis=1)
    acceleration = np.linalg.norm(recording.accelerations[:, :3], axis=1)
    return {
        'part_in_reach': this.part,
        'corners_out_of_reach': this.corners_out,
        'platform_speed': float(speed.max()),
        'platform_acceleration': float(acceleration.max()),
        'joint_speed': np.abs(recording.rates).max(axis=0).tolist(),
        'joint_effort': np.abs(recording.efforts).max(axis=0).tolist(),
        'is_compensated': this.is_compensated,
        'position_error': float(np.linalg.norm(errors[:, :3], axis=1).max()),
        'angle_error': float(np.linalg.norm(errors[:, 3:], axis=1).max()),
        'closure_error': float(recording.closure.max()),
    }


def in_words(this: Experiment, numbers: dict[str, Any]) -> list[str]:
    """The same for people."""
    drives, is_rotary = this.mechanism.drives, this.machine.kinematics.joint_unit == 'rad'
    effort, most = nearest_to(np.array(numbers['joint_effort']), drives.effort)
    speed, fastest = nearest_to(np.array(numbers['joint_speed']), drives.speed)
    factor, unit = (np.degrees(1.0), '°/s') if is_rotary else (1e3, 'mm/s')
    forces = f'{effort:.4g} {"N·m" if is_rotary else "N"} of {most:.4g}'
    if is_rotary and drives.effort.max() < 1.0:
        forces += f' ({effort / KG_CM:.3g} kg·cm of {most / KG_CM:.3g})'
    reach = f'of the 64 corners of the amplitudes {this.corners_out} are out of reach'
    if this.part < 1.0:
        reach += f'; the motion is done with {100 * this.part:.1f} % of the amplitudes'
    return [
        reach,
        f'platform     at most {1e3 * numbers["platform_speed"]:.1f} mm/s and '
        f'{numbers["platform_acceleration"]:.3g} m/s² = '
        f'{numbers["platform_acceleration"] / G:.3g} g',
        f'joint speed  at most {factor * speed:.4g} {unit} of {factor * fastest:.4g}',
        f'joint effort at most {forces}',
        f'behind by    at most {1e3 * numbers["position_error"]:.3f} mm and '
        f'{np.degrees(numbers["angle_error"]):.3f}°',
        f'loops        open by at most {1e3 * numbers["closure_error"]:.2g} mm',
    ]


def nearest_to(values: Array, limits: Array) -> tuple[float, float]:
    """The value nearest to its limit, and that limit."""
    worst = int(np.argmax(values / limits))
    return float(values[worst]), float(limits[worst])
