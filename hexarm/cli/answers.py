"""How subcommands take numbers and answer: a table for people, JSON for programs, 2 for no."""

import argparse
import json
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from hexarm.cli.statuses import REFUSED
from manipulator.errors import ManipulatorError
from manipulator.pose import Pose
from manipulator.unit_hints import check_turns

PICTURES = ('.png', '.svg', '.pdf', '.jpg')

Lines = list[str]
Answer = tuple[Mapping[str, Any], Lines]
"""What a program reads, and what a person does."""


def add_machine(parser: argparse.ArgumentParser) -> None:
    """The arguments MACHINE and --json; negative numbers may have an exponent."""
    parser.add_argument('machine', metavar='MACHINE', help='a shipped name or the path of a file')
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser._negative_number_matcher = re.compile(r'-(\d|\.\d|inf|nan)')


def add_pose(parser: argparse.ArgumentParser) -> None:
    """The arguments --xyz and --rpy."""
    parser.add_argument(
        '--xyz', nargs=3, type=float, required=True, metavar=('X', 'Y', 'Z'), help='metres'
    )
    parser.add_argument(
        '--rpy', nargs=3, type=float, default=(0.0, 0.0, 0.0), metavar=('R', 'P', 'Y'),
        help='roll, pitch, yaw about x, y, z in radians (default 0 0 0)',
    )  # fmt: skip


def pose_asked(arguments: argparse.Namespace) -> Pose:
    """The pose of --xyz and --rpy; InvalidInput for angles that are degrees."""
    check_turns(arguments.rpy)
    return Pose.from_xyz_rpy(arguments.xyz, arguments.rpy)


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
            return _refuse(str(error), arguments.json)
        except OSError as error:
            return _refuse(f'{error.filename}: {error.strerror}', arguments.json)
        if arguments.json:
            print(json.dumps(for_programs, ensure_ascii=False))
        else:
            print('\n'.join(for_people))
        return status(for_programs)

    return run


def _refuse(reason: str, is_for_programs: bool) -> int:
    if is_for_programs:
        print(json.dumps({'error': reason}, ensure_ascii=False))
    else:
        print(f'hexarm: {reason}', file=sys.stderr)
    return REFUSED
