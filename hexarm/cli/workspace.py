"""`hexarm workspace MACHINE`: ranges, volumes with their errors, pictures, and tables."""

import argparse
import csv
from pathlib import Path
from typing import Any

import numpy as np

from hexapod_control.stacks.kinematics import StackKinematics
from hexarm.cli.answers import Answer, add_machine, answering, picture_file
from hexarm.cli.progress import progress
from hexarm.machines import load
from manipulator.analysis.free_paths import is_by_joints
from manipulator.analysis.inside import conditions
from manipulator.analysis.survey import Survey, survey
from manipulator.analysis.volume import Box, Volume
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import counted, plain
from manipulator.machine import Machine
from manipulator.pose import Pose

POINTS, FEWER_POINTS, FEWEST_POINTS = 1_000_000, 20_000, 1000
MOST_POINTS = 10_000_000
SLOW_POINTS = 2000
"""For stacks, and arms that are solved numerically: up to a millisecond and more a pose."""
TABLE_POINTS = 100_000
TILT = 0.5
COLUMNS = ('x', 'y', 'z', 'admitted', 'sigma_min', 'joint_speed')


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('workspace')
    add_machine(parser)
    parser.add_argument(
        '--points', type=int, metavar='N',
        help=f'positions for the volume (default {POINTS}, for serial arms {FEWER_POINTS}, '
        f'without closed form, and stacks {SLOW_POINTS})',
    )  # fmt: skip
    parser.add_argument(
        '--tilt', type=float, default=TILT, metavar='RAD',
        help='largest roll, pitch and yaw of the volume with some orientation (default 0.5)',
    )  # fmt: skip
    parser.add_argument(
        '--picture', type=picture_file, metavar='PATH', help='a PNG, SVG or PDF file, or a folder'
    )
    parser.add_argument('--data', metavar='FILE', help='sampled positions: FILE.npz or FILE.csv')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Volumes in m³ with their errors at 95 % confidence; ranges in metres and radians."""
    machine = load(arguments.machine)
    points = default_points(machine) if arguments.points is None else arguments.points
    if not FEWEST_POINTS <= points <= MOST_POINTS:
        raise InvalidInput(f'--points {points} is outside [{FEWEST_POINTS}, {MOST_POINTS:,}]')
    if not 0.0 < arguments.tilt <= np.pi:
        raise InvalidInput(f'--tilt {arguments.tilt} rad is outside (0, π]')
    data = None if arguments.data is None else Path(arguments.data)
    if data is not None and data.suffix not in WRITERS:
        raise InvalidInput(f'--data {data}: the name must end in {" or ".join(WRITERS)}')
    with progress() as on_progress:
        found = survey(machine, points, arguments.tilt, on_progress)
        written = [] if data is None else [_table(machine, found.box, points, data)]
        if arguments.picture is not None:
            from hexarm.pictures.workspace import draw  # noqa: PLC0415 (matplotlib is an extra)

            written += draw(machine, found, arguments.picture, Path(arguments.machine).stem)
            on_progress('pictures', 1.0)
    files = [str(path) for path in written]
    return {**_for_programs(found), 'files': files}, [
        *_in_words(found),
        _sampling(machine, found),
        *files,
    ]


def default_points(machine: Machine) -> int:
    """As many positions as take a minute or two."""
    if not machine.kinematics.is_explicit:
        return SLOW_POINTS
    return FEWER_POINTS if is_by_joints(machine) else POINTS


def _for_programs(found: Survey) -> dict[str, Any]:
    def described(volume: Volume) -> dict[str, Any]:
        return {
            'value': volume.value,
            'error': volume.error,
            'confidence': volume.confidence,
            'points': volume.points,
            'unit': 'm3',
        }

    return {
        'ranges': {name: list(ends) for name, ends in found.ranges.items()},
        'volumes': {
            'constant_orientation': {
                **described(found.constant_orientation),
                'connected_share': found.connected_share,
            },
            'some_orientation': {
                **described(found.some_orientation),
                'tilt': found.tilt,
                'search_gain': found.search_gain,
            },
        },
    }


def _in_words(found: Survey) -> list[str]:
    lines = []
    for name, (low, high) in found.ranges.items():
        factor, unit = (1e3, 'mm') if name in 'xyz' else (1.0, 'rad')
        lines.append(f'{name:<6} {factor * low:>10.4f} … {factor * high:>9.4f} {unit} from home')
    constant, some = found.constant_orientation, found.some_orientation
    lines.append(f"volume with home's orientation     {_volume(constant)}")
    lines.append(f'  of it connected to home           {100 * found.connected_share:.1f} %')
    lines.append(f'volume with some orientation       {_volume(some)}')
    lines.append(
        f'  roll, pitch, yaw each within ±{found.tilt:g} rad; a lower bound: the second half of '
        f'the search found {plain(1e3 * found.search_gain, 3)} dm³ of it'
    )
    return lines


def _sampling(machine: Machine, found: Survey) -> str:
    """How the volumes were sampled."""
    sides = ' × '.join(f'{1e3 * side:.4g}' for side in found.box.high - found.box.low)
    lines = (
        f'sampled at {counted(found.constant_orientation.points, "position")} spread evenly over '
        f'{sides} mm, and at {found.some_orientation.points:,} where orientations are tried'
    )
    if isinstance(machine.kinematics, StackKinematics):
        lines += (
            '; sections share each pose as docs/kinematics.md, 9, says, others might reach more'
        )
    return lines


def _volume(volume: Volume) -> str:
    text = f'{plain(1e3 * volume.value, 5)} ± {plain(1e3 * volume.error, 2)} dm³'
    return f'{text} ({100 * volume.confidence:.0f} %, {counted(volume.points, "position")})'


def _table(machine: Machine, box: Box, points: int, path: Path) -> Path:
    """Positions spread evenly over the box, home's orientation, and what they are like."""
    places = box.lattice(min(points, TABLE_POINTS), np.full(3, 0.5))
    turned = np.broadcast_to(machine.kinematics.home.rotation, (len(places), 3, 3))
    found = conditions(machine, Pose(places, turned))
    columns = [*places.T, found.admitted, found.sigma_min, found.joint_speed]
    path.parent.mkdir(parents=True, exist_ok=True)
    WRITERS[path.suffix](path, dict(zip(COLUMNS, columns, strict=True)))
    return path


def _write_npz(path: Path, columns: dict[str, Array]) -> None:
    np.savez_compressed(path, **columns)  # type: ignore[arg-type]


def _write_csv(path: Path, columns: dict[str, Array]) -> None:
    with path.open('w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        places = (columns['x'], columns['y'], columns['z'])
        for row in zip(
            *places, columns['admitted'], columns['sigma_min'], columns['joint_speed'], strict=True
        ):
            x, y, z, admitted, sigma, speed = row
            numbers = [f'{v:.6g}' if np.isfinite(v) else '' for v in (sigma, speed)]
            writer.writerow([f'{x:.7g}', f'{y:.7g}', f'{z:.7g}', int(admitted), *numbers])


WRITERS = {'.npz': _write_npz, '.csv': _write_csv}
