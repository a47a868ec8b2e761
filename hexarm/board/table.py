"""A file of joint positions at equal time steps as a table for the board's flash.

CSV: a line of names (`time` in seconds, then the machine's joints, in any order), then rows of
numbers in radians (or metres).
"""

import csv
import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bridge.calibration import Calibration
from bridge.programs import CountTable, count_table
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import reason

TIME = 'time'
MOST_BYTES = 32_767
"""As large as avr-gcc lets one object be."""


def read_table(path: Path, calibration: Calibration) -> CountTable:
    """The table in a CSV file; ConfigError says what is wrong, and in which line."""
    try:
        with path.open(newline='', encoding='utf-8') as file:
            head, *lines = list(csv.reader(file))
        numbers = np.array([[float(cell) for cell in line] for line in lines])
    except (OSError, ValueError) as error:
        raise ConfigError([f'cannot be read as a table: {reason(error)}'], str(path)) from error
    names = [name.strip() for name in head]
    if sorted(names) != sorted([TIME, *calibration.names]) or numbers.shape[1:] != (len(names),):
        wanted = ', '.join([TIME, *calibration.names])
        raise ConfigError([f'has columns {", ".join(names)}, needs {wanted}'], str(path))
    times = numbers[:, names.index(TIME)]
    positions = numbers[:, [names.index(name) for name in calibration.names]]
    try:
        return count_table(times, positions, calibration)
    except InvalidInput as error:
        raise ConfigError([str(error)], str(path)) from error


def flash_header(table: CountTable, name: str, calibration: Calibration) -> str:
    """flash_table.h; ConfigError for a table that the chip cannot hold, or a servo not follow.

    The board does not look at all rows again before it plays them: that would take it seconds.
    """
    size = 2 * len(table.rows) * len(table.rows[0])
    if size > MOST_BYTES:
        most = MOST_BYTES // (2 * len(table.rows[0]))
        problem = f'{len(table.rows)} rows take {size} bytes of flash, at most {most} rows fit'
        raise ConfigError([problem], name)
    for k, (before, after) in enumerate(itertools.pairwise(table.rows)):
        problem = _too_fast(before, after, table.step_ms, calibration)
        if problem:
            raise ConfigError([f'row {k} to {k + 1}: {problem}'], name)
    can_loop = not _too_fast(table.rows[-1], table.rows[0], table.step_ms, calibration)
    return flash_text(table, name, can_loop)


def flash_text(table: CountTable, name: str, can_loop: bool) -> str:
    """The same of a table that is known to fit."""
    rows = '\n'.join(f'    {_braces(row)}, \\' for row in table.rows)
    return (
        f'/* Made by `hexarm firmware-header --table` from {name}. */\n#pragma once\n\n'
        f'#define FLASH_TABLE_ROWS {len(table.rows)}\n'
        f'#define FLASH_TABLE_JOINTS {len(table.rows[0])}\n'
        f'#define FLASH_TABLE_STEP_MS {table.step_ms}\n'
        f'#define FLASH_TABLE_LOOPS {int(can_loop)}\n'
        f'#define FLASH_TABLE {{ \\\n{rows}\n}}\n'
    )


def _too_fast(
    before: Sequence[int], after: Sequence[int], step_ms: int, calibration: Calibration
) -> str:
    """Which joint cannot move that far within the step, '' where all can."""
    speeds = calibration.count_speeds
    for channel, (a, b, speed) in enumerate(zip(before, after, speeds, strict=True)):
        if abs(b - a) > speed * 1e-3 * step_ms:
            joint = calibration.names[calibration.channels.index(channel)]
            needed = abs(b - a) / (speed * 1e-3 * step_ms)
            return f'{joint} would have to be {needed:.3g} times as fast as its servo'
    return ''


def _braces(row: Sequence[int]) -> str:
    return f'{{{", ".join(map(str, row))}}}'
