"""`hexarm reach MACHINE --xyz X Y Z --rpy R P Y`: the limits a pose meets, the nearest pose."""

import argparse
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from hexarm.cli.answers import (
    Answer,
    Lines,
    Units,
    add_machine,
    add_pose,
    answering,
    for_programs,
    pose_asked,
    units_of,
)
from hexarm.cli.statuses import OUT_OF_REACH, STATUSES
from hexarm.machines import load
from manipulator.analysis.nearest import nearest_reachable
from manipulator.analysis.reach import Reach, reach
from manipulator.analysis.readings import LimitReading
from manipulator.analysis.travel import Travel, travel

SHOWN = 6


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('reach', epilog=STATUSES)
    add_machine(parser)
    add_pose(parser)
    parser.add_argument(
        '--along', nargs=6, type=float, metavar=('VX', 'VY', 'VZ', 'WX', 'WY', 'WZ'),
        help='how far the pose can go along this twist in base axes, m/s, rad/s (or mm/s, °/s)',
    )  # fmt: skip
    parser.set_defaults(run=answering(answer, status))


def answer(arguments: argparse.Namespace) -> Answer:
    """Out of reach is an answer, too; only what is no pose or no twist is refused."""
    machine = load(arguments.machine)
    pose = pose_asked(arguments)
    found = reach(machine, pose)
    nearest = None if found.is_reachable else nearest_reachable(machine, pose)
    units = units_of(arguments)
    found_as_json: dict[str, Any] = {
        'reachable': found.is_reachable,
        'reason': found.reason,
        'limits': [_reading(r) for r in found.limits],
        'nearest': None,
    }
    lines = _in_words(found, units)
    if nearest is not None:
        found_as_json['nearest'] = {**for_programs(nearest.pose), 'distance': nearest.distance}
        lines += ['nearest reachable', *units.pose(nearest.pose)]
    if arguments.along is not None:
        scale = [units.per_metre] * 3 + [units.per_radian] * 3
        left = travel(machine, pose, np.array(arguments.along) / scale)
        found_as_json['travel'] = {
            'seconds': left.seconds,
            'metres': left.metres,
            'end': for_programs(left.pose),
            'reason': left.reason,
        }
        lines.append(_travel_in_words(left, units))
    return found_as_json, lines


def status(answer: Mapping[str, Any]) -> int:
    """The exit status of an answer."""
    return 0 if answer['reachable'] else OUT_OF_REACH


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


def _in_words(found: Reach, units: Units) -> Lines:
    lines = ['reachable' if found.is_reachable else f'out of reach: {found.reason}']
    if found.limits:
        head = ('limit', 'value', 'range', 'margin', 'about')
        lines.append('{:<30} {:>10}   {:<22} {:>10}  {:>11}'.format(*head))
    for reading in found.limits[: max(SHOWN, len(found.broken))]:
        factor, unit = units.factor(reading.unit), units.name(reading.unit)
        name = ': '.join(filter(None, (reading.owner, reading.quantity)))
        ends = (_bound(factor * reading.low), '…', _bound(factor * reading.high), unit)
        span = ' '.join(filter(None, ends))
        value, margin = (units.number(v, reading.unit) for v in (reading.value, reading.margin))
        values = f'{value:>10}   {span:<22} {margin:>10}'
        lines.append(f'{name:<30} {values}  {_distance(reading.distance, units):>11}')
    return lines


def _distance(metres: float, units: Units) -> str:
    return units.quantities([metres], 'm') if math.isfinite(metres) else ''


def _bound(value: float) -> str:
    return f'{value:.4g}' if math.isfinite(value) else ''


def _travel_in_words(left: Travel, units: Units) -> str:
    reason = f', then {left.reason}' if left.reason else ', and no limit was met'
    return f'goes on for {left.seconds:.3f} s, {units.quantities([left.metres], "m")}{reason}'
