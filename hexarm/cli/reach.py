"""`hexarm reach MACHINE --xyz X Y Z --rpy R P Y`: the limits a pose meets, the nearest pose."""

import argparse
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from hexarm.cli.answers import (
    Answer,
    Lines,
    add_machine,
    add_pose,
    answering,
    pose_asked,
)
from hexarm.cli.statuses import OUT_OF_REACH
from hexarm.machines import load
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.reach import Reach, pose_in_words, reach
from manipulator.analysis.readings import LimitReading
from manipulator.analysis.travel import Travel, travel
from manipulator.formatting import length
from manipulator.pose import Pose

SHOWN = 6
FOR_PEOPLE = {'m': (1e3, 'mm'), 'rad': (math.degrees(1.0), '°')}


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        'reach',
        help='which limits a pose meets; the nearest reachable',
        epilog=f'Exit status: 0 reachable, {OUT_OF_REACH} out of reach, 2 not understood.',
    )
    add_machine(parser)
    add_pose(parser)
    parser.add_argument(
        '--along', nargs=6, type=float, metavar=('VX', 'VY', 'VZ', 'WX', 'WY', 'WZ'),
        help='how far the pose can go along this twist, m/s and rad/s in base axes',
    )  # fmt: skip
    parser.set_defaults(run=answering(answer, status))


def answer(arguments: argparse.Namespace) -> Answer:
    """Out of reach is an answer, too; only what is no pose or no twist is refused."""
    machine = load(arguments.machine)
    pose = pose_asked(arguments)
    found = reach(machine, pose)
    nearest = None if found.is_reachable else nearest_reachable(machine, pose)
    for_programs: dict[str, Any] = {
        'reachable': found.is_reachable,
        'reason': found.reason,
        'limits': [_reading(r) for r in found.limits],
        'nearest': None,
    }
    lines = _in_words(found)
    if nearest is not None:
        for_programs['nearest'] = {**_pose(nearest.pose), 'distance': nearest.distance}
        lines.append(f'nearest reachable   {pose_in_words(nearest.pose)}')
    if arguments.along is not None:
        left = travel(machine, pose, np.array(arguments.along))
        for_programs['travel'] = {
            'seconds': left.seconds,
            'metres': left.metres,
            'end': _pose(left.pose),
            'reason': left.reason,
        }
        lines.append(_travel_in_words(left))
    return for_programs, lines


def status(answer: Mapping[str, Any]) -> int:
    """The exit status of an answer."""
    return 0 if answer['reachable'] else OUT_OF_REACH


def _pose(pose: Pose) -> dict[str, list[float]]:
    return {'xyz': pose.position.tolist(), 'quaternion_xyzw': pose.quaternion.tolist()}


def _reading(reading: LimitReading) -> dict[str, Any]:
    return {
        'quantity': reading.quantity,
        'owner': reading.owner,
        'value': reading.value,
        'low': _finite(reading.low),
        'high': _finite(reading.high),
        'unit': reading.unit,
        'margin': reading.margin,
        'distance': _finite(reading.distance),
    }


def _finite(value: float) -> float | None:
    """JSON knows no ∞: a bound that is not there is null."""
    return value if math.isfinite(value) else None


def _in_words(found: Reach) -> Lines:
    lines = ['reachable' if found.is_reachable else f'out of reach: {found.reason}']
    if found.limits:
        head = ('limit', 'value', 'range', 'margin', 'about')
        lines.append('{:<30} {:>10}   {:<20} {:>10}  {:>11}'.format(*head))
    for reading in found.limits[: max(SHOWN, len(found.broken))]:
        factor, unit = FOR_PEOPLE.get(reading.unit, (1.0, reading.unit))
        name = f'{reading.owner}: {reading.quantity}' if reading.owner else reading.quantity
        span = f'{_bound(factor * reading.low)} … {_bound(factor * reading.high)} {unit}'
        values = f'{factor * reading.value:>10.3f}   {span:<20} {factor * reading.margin:>10.3f}'
        lines.append(f'{name:<30} {values}  {length(reading.distance, 3):>11}')
    return lines


def _bound(value: float) -> str:
    return f'{value:.4g}' if math.isfinite(value) else ''


def _travel_in_words(left: Travel) -> str:
    reason = f', then {left.reason}' if left.reason else ', and no limit was met'
    return f'goes on for {left.seconds:.3f} s, {length(left.metres)}{reason}'
