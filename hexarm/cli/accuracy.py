"""`hexarm accuracy MACHINE`: pose errors from servos and geometry, by law and by chance."""

import argparse
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bridge.servo_config import BoardConfig
from hexapod_control.geometry_errors import GeometryErrors
from hexapod_control.parallel_platform import ParallelPlatform
from hexarm.cli.answers import Answer, add_machine, answering, picture_file
from hexarm.machines import load, read
from manipulator.analysis.accuracy import JointErrors, Spread, drawn_spread, linear_spread
from manipulator.analysis.free_paths import admits
from manipulator.analysis.volume import bounding_box, with_orientation
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import decimals
from manipulator.kinematics import Kinematics
from manipulator.machine import Machine, MachineFile
from manipulator.pose import Pose

PAPER_MACHINE, PAPER_NOISE = 'robocake', math.radians(1.0)
"""Prokopovich 2019: 1° of an SG90."""
TOLERANCE = 1e-4
DRAWS, FEWEST_DRAWS, MOST_DRAWS = 4000, 100, 100_000
MACHINES = 400
MAP_POSITIONS = 4000
PAPER_UM = {
    'noise, all joints': 9.9,
    'noise, joint 1': 24.7,
    'noise, joints 1, 3, 5': 30.0,
    'one signal, all joints': 9.9,
    'one signal, joints 1, 3, 5': 30.0,
}
"""Prokopovich 2019, section on accuracy, with 1° of noise on the RoboCake."""


@dataclass(frozen=True)
class Row:
    """One cause of errors, and the spread that it makes at home; paper in metres."""

    cause: str
    linear: Spread
    drawn: Spread
    paper: float | None = None


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('accuracy')
    add_machine(parser)
    parser.add_argument(
        '--noise', type=float, metavar='A',
        help='uniform servo noise within ±A, rad or m (default: the play of the servos in the '
        'machine file, 1° for the RoboCake)',
    )  # fmt: skip
    parser.add_argument(
        '--tolerance', type=float, default=TOLERANCE, metavar='M',
        help='standard deviation of joint coordinates and lengths, m (default 0.0001)',
    )  # fmt: skip
    parser.add_argument(
        '--draws', type=int, default=DRAWS, metavar='N', help=f'for each cause (default {DRAWS})'
    )
    parser.add_argument(
        '--picture',
        type=picture_file,
        metavar='FILE',
        help='a map of the error over the workspace',
    )
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """The spread of the pose at home by each cause, and over the positions reached unturned."""
    machine, file = load(arguments.machine), read(arguments.machine)
    is_papers = file.kind == 'rotary_hexapod' and file.geometry == read(PAPER_MACHINE).geometry
    noise = arguments.noise
    if noise is None:
        noise = PAPER_NOISE if is_papers else play_of(file)
    for name, value in (('--noise', noise), ('--tolerance', arguments.tolerance)):
        if not 0.0 <= value < 1.0:
            raise InvalidInput(f'{name} {value:g} is outside [0, 1)')
    if not FEWEST_DRAWS <= arguments.draws <= MOST_DRAWS:
        raise InvalidInput(
            f'--draws {arguments.draws} is outside [{FEWEST_DRAWS}, {MOST_DRAWS:,}]'
        )
    is_papers = is_papers and math.isclose(noise, PAPER_NOISE)
    errors = servo_errors(machine.kinematics, file, noise)
    common = common_error(file, noise, len(machine.kinematics.joint_names))
    causes = {**servo_causes(errors), **common_causes(common)}
    found = list(rows(machine.kinematics, causes, arguments.draws, is_papers))
    found += geometry_rows(machine.kinematics, arguments.tolerance, arguments.draws)
    everywhere = error_map(machine, errors)
    lines = [*_in_words(found), *_map_in_words(everywhere)]
    for_programs: dict[str, Any] = {
        'noise': noise,
        'rows': [_for_programs(row) for row in found],
        'map': {name: _summary(values) for name, values in everywhere.items()},
    }
    if arguments.picture is not None:
        from hexarm.pictures.accuracy import draw  # noqa: PLC0415 (matplotlib is an extra)

        draw(machine, errors, arguments.picture, Path(arguments.machine).stem)
        lines.append(str(arguments.picture))
    return for_programs, lines


def play_of(file: MachineFile) -> float:
    """What the machine file says of its servos' play, rad or m; InvalidInput where nothing."""
    play = BoardConfig.from_machine(file).hysteresis if file.driver == 'serial' else 0.0
    if play > 0.0:
        return play
    raise InvalidInput(
        'the machine file gives no play of the servos (simulation.hysteresis_deg or '
        'hysteresis_mm): give --noise A, in rad or m'
    )


def servo_errors(kinematics: Kinematics, file: MachineFile, noise: float) -> JointErrors:
    """The requested noise, dead band and play of the machine file's simulated servos."""
    count = len(kinematics.joint_names)
    if file.driver != 'serial':
        return JointErrors(np.full(count, noise), np.zeros(count), np.zeros(count))
    config = BoardConfig.from_machine(file)
    servos = config.servos.joints[:count]  # an arm's gripper comes after its joints
    per_unit = [servo.us_per_mm or servo.us_per_deg or math.inf for servo in servos]
    unit = 1e-3 if kinematics.joint_unit == 'm' else math.radians(1.0)
    return JointErrors(
        np.full(count, noise),
        unit * config.simulation.dead_band_us / np.array(per_unit),
        np.full(count, config.hysteresis),
    )


def common_error(file: MachineFile, noise: float, joints: int) -> JointErrors:
    """One signal within ±noise on all servos, in the direction that each servo turns."""
    if file.driver != 'serial':
        return JointErrors.common(np.full(joints, noise))
    servos = BoardConfig.from_machine(file).servos.joints[:joints]
    return JointErrors.common(noise * np.array([float(servo.sign) for servo in servos]))


def servo_causes(errors: JointErrors) -> dict[str, JointErrors]:
    """Each cause alone, independent from joint to joint, then all together."""
    zero = np.zeros(len(errors.noise))
    noise = JointErrors(errors.noise, zero, zero)
    return {
        'noise, all joints': noise,
        'noise, joint 1': noise.on((0,)),
        'noise, joints 1, 3, 5': noise.on((0, 2, 4)),
        'dead band, all joints': JointErrors(zero, errors.dead_band, zero),
        'hysteresis, all joints': JointErrors(zero, zero, errors.hysteresis),
        'all of the servos': errors,
    }


def common_causes(common: JointErrors) -> dict[str, JointErrors]:
    """One and the same noise on several servos."""
    return {
        'one signal, all joints': common,
        'one signal, joints 1, 3, 5': common.on((0, 2, 4)),
    }


def rows(
    kinematics: Kinematics, causes: dict[str, JointErrors], draws: int, is_papers: bool
) -> Iterator[Row]:
    """The spread at home by each cause."""
    home = kinematics.home
    for cause, some in causes.items():
        paper = 1e-6 * PAPER_UM[cause] if is_papers and cause in PAPER_UM else None
        drawn = drawn_spread(kinematics, home, some, draws, np.random.default_rng(1))
        yield Row(cause, linear_spread(kinematics, home, some), drawn, paper)


def geometry_rows(kinematics: Kinematics, tolerance: float, draws: int) -> Iterator[Row]:
    """The spread at home by joint coordinates and lengths, of platforms."""
    if isinstance(kinematics, ParallelPlatform):
        home, geometry = kinematics.home, GeometryErrors(tolerance)
        generator = np.random.default_rng(2)
        built = geometry.drawn_spread(kinematics, home, min(draws, MACHINES), generator)
        yield Row('geometry', geometry.linear_spread(kinematics, home), built)


def error_map(machine: Machine, errors: JointErrors) -> dict[str, Array]:
    """Rms position (m) and angle (rad) by all servo errors, linear, over unturned positions."""
    home = machine.kinematics.home
    reached = with_orientation(machine, home.rotation)
    box = bounding_box(reached, home.position, machine.kinematics.characteristic_length)
    places = box.lattice(MAP_POSITIONS, np.full(3, 0.5))
    poses = Pose(places, np.broadcast_to(home.rotation, (len(places), 3, 3)))
    spread = linear_spread(machine.kinematics, poses[admits(machine, poses)], errors)
    return {'position': spread.position_rms, 'angle': spread.angle_rms}


def _for_programs(row: Row) -> dict[str, Any]:
    return {
        'cause': row.cause,
        'position_rms': float(row.linear.position_rms),
        'angle_rms': float(row.linear.angle_rms),
        'drawn': {
            'position_rms': float(row.drawn.position_rms),
            'angle_rms': float(row.drawn.angle_rms),
            'draws': row.drawn.draws,
            'relative_error': row.drawn.relative_error,
        },
        'paper_position_rms': row.paper,
    }


def _summary(values: Array) -> dict[str, float]:
    return {
        'least': float(values.min()),
        'median': float(np.median(values)),
        'largest': float(values.max()),
    }


def _in_words(found: list[Row]) -> list[str]:
    line = '{:<27} {:>10} {:>16} {:>10} {:>14}'
    head = ('rms at home', 'position', 'drawn', 'angle', 'drawn')
    lines = [line.format(*head) + ('   paper' if found[0].paper else '')]
    some, more = (
        decimals(float(max(rms(row.linear) for row in found))) for rms in (_millimetres, _degrees)
    )
    for row in found:
        share = row.drawn.relative_error
        place, turn = _millimetres(row.drawn), _degrees(row.drawn)
        numbers = (
            f'{_millimetres(row.linear):.{some}f} mm',
            f'{place:.{some}f} ± {share * place:.{some}f}',
            f'{_degrees(row.linear):.{more}f}°',
            f'{turn:.{more}f} ± {share * turn:.{more}f}',
        )
        paper = f'   {1e3 * row.paper:.4f} mm' if row.paper else ''
        lines.append(line.format(row.cause, *numbers) + paper)
    if found[0].paper:
        lines += [
            'The paper (Prokopovich 2019) has less error on all six servos than on one.',
            'Independent errors do not cancel: their squares add. One signal on all six servos',
            'does: they turn the platform about z, and shift it to second order only.',
        ]
    return lines


def _millimetres(spread: Spread) -> float:
    return 1e3 * float(spread.position_rms)


def _degrees(spread: Spread) -> float:
    return math.degrees(float(spread.angle_rms))


def _map_in_words(everywhere: dict[str, Array]) -> list[str]:
    place, turn = 1e3 * everywhere['position'], np.degrees(everywhere['angle'])
    return [
        'all of the servos, over the positions reached unturned: '
        f'{_summary_in_words(place, " mm")}, {_summary_in_words(turn, "°")}'
    ]


def _summary_in_words(values: Array, unit: str) -> str:
    found = _summary(values)
    digits = decimals(found['largest'], fewest=3)
    least, median, largest = (f'{found[k]:.{digits}f}' for k in ('least', 'median', 'largest'))
    return f'{least} … {largest}{unit} (median {median})'
