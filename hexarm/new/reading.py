"""How `hexarm new` reads an answer, typed or from a YAML file; InvalidInput says why not."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from manipulator.errors import InvalidInput
from manipulator.formatting import not_one_of, shown

Parse = Callable[[Any], Any]
SIZE, PLACE, ANGLE = (0.001, 1e6), (-1e6, 1e6), (-360.0, 360.0)


def number(bounds: tuple[float, float]) -> Parse:
    """One number."""
    return lambda value: _numbers(value, (1,), bounds)[0]


def numbers(counts: tuple[int, ...], bounds: tuple[float, float]) -> Parse:
    """So many numbers, in a list or with spaces or commas between them."""
    return lambda value: _numbers(value, counts, bounds)


def table(parse_row: Parse, count: int) -> Parse:
    """So many rows, in a list or with semicolons between them."""

    def parse(value: Any) -> list[Any]:
        rows = value.strip().strip(';').split(';') if isinstance(value, str) else value
        if not isinstance(rows, Sequence) or len(rows) != count:
            found = f'{len(rows)} rows' if isinstance(rows, Sequence) else shown(value)
            raise InvalidInput(f'{found}, needs {count}, in a list or with semicolons')
        return [_row(parse_row, k, row) for k, row in enumerate(rows, start=1)]

    return parse


def _row(parse_row: Parse, k: int, row: Any) -> Any:
    try:
        return parse_row(row)
    except InvalidInput as error:
        raise InvalidInput(f'row {k}: {error}') from error


def one_of(choices: Mapping[str, str]) -> Parse:
    """One of these words, or its number in the list, from 1."""
    words = list(choices)

    def parse(value: Any) -> str:
        typed = str(value).strip()
        if typed.isdigit() and 1 <= int(typed) <= len(words):
            return words[int(typed) - 1]
        for word in words:
            if word.lower() == typed.lower():
                return word
        raise InvalidInput(not_one_of(typed, words))

    return parse


def height(value: Any) -> float | str:
    """A height, or the word auto."""
    if str(value).strip().lower() == 'auto':
        return 'auto'
    return float(_numbers(value, (1,), PLACE)[0])


UNIT = re.compile(r'[-+]?[\d.]*(mm|cm|m|in|inch|inches|"|°|deg|rad|g|kg|N)')
"""What people write behind a number, or next to it."""


def words(value: Any) -> str:
    """A text on one line."""
    return ' '.join(''.join(c if c.isprintable() else ' ' for c in str(value)).split())


def _numbers(value: Any, counts: tuple[int, ...], bounds: tuple[float, float]) -> list[float]:
    if isinstance(value, str):
        parts: Sequence[Any] = value.strip('[]() ').replace(',', ' ').split()
    else:
        parts = value if isinstance(value, Sequence) else [value]
    found = [_number(part) for part in parts]
    if len(found) not in counts:
        some = 'one number' if counts == (1,) else f'{" or ".join(map(str, counts))} numbers'
        comma = re.search(r'\d+,\d+', value) if isinstance(value, str) else None
        hint = f'; decimals have a point: {comma[0].replace(",", ".")}' if comma else ''
        raise InvalidInput(
            f'{len(found)} numbers, needs {some}{hint}' if found else f'needs {some}'
        )
    for each in found:
        if not bounds[0] <= each <= bounds[1]:
            raise InvalidInput(f'{each:g} is outside {bounds[0]:g} … {bounds[1]:g}')
    return found


def _number(part: Any) -> float:
    try:
        if isinstance(part, bool):
            raise ValueError
        value = float(part)
    except (TypeError, ValueError):
        has_unit = isinstance(part, str) and UNIT.fullmatch(part)
        hint = ': mm, ° and g are meant, without a unit' if has_unit else ''
        raise InvalidInput(f'{shown(part)} is not a number{hint}') from None
    if not math.isfinite(value):
        raise InvalidInput(f'{shown(part)} is not a number')
    return value
