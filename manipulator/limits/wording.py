"""Violated limits in the words and units of a machine file, alike ones together."""

import math
import re
from collections.abc import Iterable, Sequence

import numpy as np

from manipulator.arrays import Array
from manipulator.limits.limit import Violation

UNITS = {'rad': (math.degrees(1.0), '°'), 'm': (1e3, ' mm')}
"""Of machine files: how many are one of ours, and their name."""
DECIMALS = 5
MEETING = re.compile(r'(.*?) (\d+) ((?:meets|leaves) .*)')
"""A sentence of `Limit.owners` about one of several parts."""


def in_words(violations: Iterable[Violation]) -> list[str]:
    """One text for each limit, as 'crank angle -173.8° on all legs, outside [-90, 90]°'."""
    alike: dict[tuple[object, ...], list[Violation]] = {}
    meetings: dict[tuple[object, ...], list[Violation]] = {}
    for violation in violations:
        if violation.quantity:
            key = violation.quantity, violation.low, violation.high
            alike.setdefault(key, []).append(violation)
        else:
            part, _, what = _meeting(violation)
            meetings.setdefault((part, what), []).append(violation)
    return [*map(_of_one_limit, alike.values()), *map(_of_meetings, meetings.values())]


def degrees_in_words(angles: Array) -> str:
    """Angles in radians as degrees: '0°', or '0.1°, 0.2°' where they differ."""
    return _listed(np.degrees(angles), '°', 4)


def millimetres_in_words(lengths: Array) -> str:
    """Lengths in metres likewise: '50 mm', or '50 mm, 60 mm'."""
    return _listed(1e3 * lengths, ' mm', 4)


def _of_one_limit(some: Sequence[Violation]) -> str:
    factor, unit = UNITS.get(some[0].unit, (1.0, ''))
    digits = max(v.digits for v in some)
    low, high = (f'{factor * end:.{digits}g}' for end in (some[0].low, some[0].high))
    span = f'outside [{low}, {high}]'
    if not math.isfinite(some[0].high):
        span = f'below {low}'
    elif not math.isfinite(some[0].low):
        span = f'above {high}'
    values = _listed(np.array([v.value for v in some]) * factor, unit, digits)
    owners = _owners([v.owner for v in some])
    return f'{some[0].quantity} {values}{owners}, {span}{unit}'


def _meeting(violation: Violation) -> tuple[str, str, str]:
    """As 'rod', '3', 'meets the floor'; a part without a number is whole."""
    found = MEETING.fullmatch(violation.owner)
    return (found[1], found[2], found[3]) if found else (violation.owner, '', '')


def _of_meetings(some: Sequence[Violation]) -> str:
    """As 'rods 1, 2 meet the floor by 4 mm', by as much as the worst of them."""
    if len(some) == 1:
        return str(some[0])
    part, _, what = _meeting(some[0])
    verb, _, rest = what.partition(' ')
    numbers = ', '.join(_meeting(violation)[1] for violation in some)
    most = 1e3 * max(violation.excess for violation in some)
    return f'{part}s {numbers} {verb[:-1]} {rest} by {most:.3g} mm'


def _owners(owners: Sequence[str]) -> str:
    """As ' on legs 1, 3', of 'leg 1' and 'leg 3'; empty where nobody in particular is meant."""
    numbers = [owner.split(' ')[-1] for owner in owners if owner]
    if not numbers:
        return ''
    noun = owners[0].split(' ')[0]
    if len(numbers) == 1:
        return f' on {noun} {numbers[0]}'
    return f' on all {noun}s' if len(numbers) == 6 else f' on {noun}s {", ".join(numbers)}'


def _listed(values: Array, unit: str, digits: int) -> str:
    texts = [f'{value:.{digits}g}{unit}' for value in np.round(values, DECIMALS) + 0.0]
    return texts[0] if len(set(texts)) == 1 else ', '.join(texts)
