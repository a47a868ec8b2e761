"""How subcommands take numbers and answer: lines for people, JSON for programs, a status."""

import argparse
import json
import math
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hexarm.cli.statuses import FAILED, OUT_OF_REACH, REFUSED
from manipulator.errors import ManipulatorError, Stopped, TimedOut, Unreachable
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns

PICTURES = ('.png', '.svg', '.pdf', '.jpg')

Lines = list[str]
Answer = tuple[Mapping[str, Any], Lines]
"""What a program reads, and what a person does."""


@dataclass(frozen=True)
class Units:
    """In which lengths and angles are typed and printed: their names and how many are one in SI.

    decimals: of lengths and of angles.
    """

    length: str
    angle: str
    per_metre: float
    per_radian: float
    decimals: tuple[int, int]

    def factor(self, unit: str) -> float:
        """How many of ours are one of 'm' or 'rad'; 1 of anything else."""
        return {'m': self.per_metre, 'rad': self.per_radian}.get(unit, 1.0)

    def name(self, unit: str) -> str:
        """Of ours, in place of 'm' or 'rad'."""
        return {'m': self.length, 'rad': self.angle}.get(unit, unit)

    def number(self, value: float, unit: str) -> str:
        """A value in SI as a number in our unit, with its decimals."""
        digits = self.decimals[unit == 'rad']
        return f'{round(value * self.factor(unit), digits) + 0.0:.{digits}f}'

    def quantities(self, values: Iterable[float], unit: str) -> str:
        """Values in SI as numbers with our unit."""
        return f'{"  ".join(self.number(v, unit) for v in values)} {self.name(unit)}'

    def pose(self, pose: Pose) -> list[str]:
        """Two lines: position, and orientation."""
        return [
            f'x, y, z            {self.quantities(pose.position, "m")}',
            f'roll, pitch, yaw   {self.quantities(pose.rpy, "rad")}',
        ]


UNITS = {
    'si': Units('m', 'rad', 1.0, 1.0, (6, 6)),
    'mm': Units('mm', '°', 1e3, math.degrees(1.0), (3, 4)),
}


def add_units(parser: argparse.ArgumentParser) -> None:
    """The argument --units."""
    parser.add_argument(
        '--units', choices=tuple(UNITS), default='si',
        help='of what is typed and printed: m and rad (si, the default), or mm and ° (mm); '
        '--json prints m and rad in any case',
    )  # fmt: skip


def units_of(arguments: argparse.Namespace) -> Units:
    """Those of --units."""
    return UNITS[arguments.units]


def for_programs(pose: Pose) -> dict[str, list[float]]:
    """Metres and a unit quaternion."""
    return {'xyz': pose.position.tolist(), 'quaternion_xyzw': pose.quaternion.tolist()}


def with_negatives(parser: argparse.ArgumentParser) -> None:
    """Lets negative numbers have an exponent, and not be taken for options."""
    parser._negative_number_matcher = re.compile(r'-(\d|\.\d|inf|nan)')


def add_machine(parser: argparse.ArgumentParser) -> None:
    """The arguments MACHINE and --json; negative numbers may have an exponent."""
    machine = parser.add_argument(
        'machine', metavar='MACHINE', help='a shipped name or the path of a file'
    )
    machine.completer = complete_machine  # type: ignore[attr-defined]
    parser.add_argument('--json', action='store_true', help='answer for programs')
    with_negatives(parser)


def complete_machine(**_: object) -> list[str]:
    """The names that argcomplete offers for MACHINE."""
    from hexarm.machines import shipped  # noqa: PLC0415 (only to complete a word)

    return list(shipped())


def add_pose(parser: argparse.ArgumentParser) -> None:
    """The arguments --xyz, --rpy and --units."""
    parser.add_argument(
        '--xyz', nargs=3, type=float, required=True, metavar=('X', 'Y', 'Z'), help='m (or mm)'
    )
    parser.add_argument(
        '--rpy', nargs=3, type=float, default=(0.0, 0.0, 0.0), metavar=('R', 'P', 'Y'),
        help='roll, pitch, yaw about x, y, z in rad (or °; default 0 0 0)',
    )  # fmt: skip
    add_units(parser)


def pose_asked(arguments: argparse.Namespace) -> Pose:
    """The pose of --xyz and --rpy; InvalidInput for angles that are degrees."""
    units = units_of(arguments)
    turns = [value / units.per_radian for value in arguments.rpy]
    check_turns(turns)
    return Pose.from_xyz_rpy([value / units.per_metre for value in arguments.xyz], turns)


def picture_file(name: str) -> Path:
    """A path that matplotlib can save to: a picture's ending, or none for a folder."""
    path = Path(name)
    if path.suffix.lower() not in ('', *PICTURES):
        known = ', '.join(PICTURES)
        raise argparse.ArgumentTypeError(f'{name}: a picture ends in one of {known}')
    return path


def answering(
    answer: Callable[[argparse.Namespace], Answer],
    status: Callable[[Mapping[str, Any]], int] = lambda for_programs: 0,
) -> Callable[..., int]:
    """A subcommand's `run`: prints the answer, or why there is none; `status` of an answer."""

    def run(arguments: argparse.Namespace) -> int:
        try:
            for_programs, for_people = answer(arguments)
        except ManipulatorError as error:
            return refuse(str(error), arguments.json, status_of_error(error))
        except OSError as error:
            return refuse(f'{error.filename}: {error.strerror}', arguments.json)
        if arguments.json:
            print(json.dumps(for_programs, ensure_ascii=False))
        else:
            print('\n'.join(for_people))
        return status(for_programs)

    return run


def status_of_error(error: ManipulatorError) -> int:
    """Out of reach, failed, or refused."""
    if isinstance(error, Unreachable):
        return OUT_OF_REACH
    return FAILED if isinstance(error, Stopped | TimedOut) else REFUSED


def refuse(reason: str, is_for_programs: bool, status: int = REFUSED) -> int:
    """Prints why there is no answer; the status."""
    if is_for_programs:
        print(json.dumps({'error': reason}, ensure_ascii=False))
    else:
        print(f'hexarm: {reason}', file=sys.stderr)
    return status
