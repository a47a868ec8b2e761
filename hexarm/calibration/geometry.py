"""`hexarm calibrate geometry MACHINE CSV`: the machine that measured poses are of."""

import argparse
from dataclasses import dataclass

import numpy as np

from bridge.servo_config import BoardConfig
from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.geometry_report import for_programs, in_words
from hexarm.calibration.machine_writer import MachineWriter, machine_model, new_geometry
from hexarm.calibration.poses import measurements
from hexarm.cli.answers import Answer, add_machine, answering
from hexarm.machines import load, read
from manipulator.analysis.identify import identify
from manipulator.analysis.measurements import Measurements, Noise
from manipulator.arrays import Array
from manipulator.errors import InvalidInput, NoSolution
from manipulator.formatting import shown
from manipulator.kinematics import Kinematics
from manipulator.machine import MachineFile
from manipulator.pose import Pose
from manipulator.yaml_edit import Place, with_section, with_values

NOISE_MM, NOISE_DEG = 0.1, 0.057
TOLERANCE_MM, TOLERANCE_DEG = 0.5, 1.0


@dataclass(frozen=True)
class Option:
    """A number that the command takes."""

    name: str
    usual: float
    help: str


OPTIONS = (
    Option('--noise-mm', NOISE_MM, "the device's noise, an axis"),
    Option('--noise-deg', NOISE_DEG, 'the same for the orientation'),
    Option('--tolerance-mm', TOLERANCE_MM, 'how well lengths were built'),
    Option('--tolerance-deg', TOLERANCE_DEG, 'how well zeros, headings, tilts and twists were'),
)


def add_parser(parts: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the part."""
    parser = parts.add_parser('geometry', help='joints, lengths and zeros from measured poses')
    add_machine(parser)
    parser.add_argument('measurements', metavar='CSV', help='see docs/calibration.md')
    parser.add_argument('--output', metavar='FILE', help='write a copy instead of MACHINE')
    parser.add_argument('--dry-run', action='store_true', help='only print the result')
    parser.add_argument(
        '--free', nargs='+', metavar='GROUP',
        help='what is sought (default: all that the machine has): anchors, joints, cranks, rods, '
        'zeros, headings, tilts, rails of a platform; zeros, lengths, twists of an arm; device '
        'and marker, the frames of the measuring device',
    )  # fmt: skip
    for option in OPTIONS:
        parser.add_argument(
            option.name, type=float, default=option.usual, metavar='S',
            help=f'{option.help}; standard deviation (default {option.usual:g})',
        )  # fmt: skip
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Prints the result, and writes it unless --dry-run is given."""
    writer = None if arguments.dry_run else MachineWriter(arguments.machine, arguments.output)
    file, machine = read(arguments.machine), load(arguments.machine)
    kinematics = machine.kinematics
    tolerances = Tolerances(
        1e-3 * _positive('--tolerance-mm', arguments.tolerance_mm),
        float(np.radians(_positive('--tolerance-deg', arguments.tolerance_deg))),
    )
    noise = Noise(1e-3 * arguments.noise_mm, float(np.radians(arguments.noise_deg)))
    model = machine_model(kinematics, tolerances)
    table = measurements(arguments.measurements, kinematics.joint_names, kinematics.joint_unit)
    groups = [p.group for p in model.parameters]
    free = arguments.free or [*dict.fromkeys(groups), 'device', 'marker']
    found = identify(model, table, noise, _nominal(kinematics, table), free)
    lines = in_words(found, noise, model.rigid_motions(found.model_values))
    if writer is not None:
        values = found.model_values
        offsets = model.joint_offsets(values)
        lines_of_geometry, text = new_geometry(model, values), writer.text
        if lines_of_geometry:
            text = with_section(text, 'geometry', lines_of_geometry)
        text = with_values(text, centres(file, kinematics.joint_names, offsets))
        problems = writer.write(text)
        lines += ['', f'{writer.target}: written']
        lines += [f'  to be looked at: {problem}' for problem in problems]
    return for_programs(found), lines


def centres(file: MachineFile, names: tuple[str, ...], offsets: Array) -> dict[Place, str]:
    """The servos' centres, in the file's unit, each moved by its offset (rad or m)."""
    found: dict[Place, str] = {}
    servos = BoardConfig.from_machine(file).servos.joints
    by_name = {servo.name: (i, servo) for i, servo in enumerate(servos)}
    for name, offset in zip(names, offsets, strict=True):
        if name not in by_name:
            raise InvalidInput(f'servos.joints: none is called {shown(name)}')
        i, servo = by_name[name]
        key = 'centre_mm' if servo.is_linear else 'centre_deg'
        unit = 1e-3 if servo.is_linear else np.radians(1.0)
        centre = float(getattr(servo, key)) + float(offset) / unit
        if round(float(offset) / unit, 4) != 0.0:
            found['servos', 'joints', i, key] = f'{centre:.4f}'
    return found


def _nominal(kinematics: Kinematics, table: Measurements) -> Pose:
    """The pose of the file's machine with the commanded joints."""
    poses = []
    for row, joints in enumerate(table.joints, start=1):
        try:
            poses.append(kinematics.forward(joints).pose)
        except NoSolution as error:
            raise NoSolution(f'measured pose {row}: {error}') from error
    return Pose(np.stack([p.position for p in poses]), np.stack([p.rotation for p in poses]))


def _positive(name: str, value: float) -> float:
    if not 0.0 < value < 1000.0:
        raise InvalidInput(f'{name} {value:g} outside (0, 1000)')
    return value
