"""A file of joint positions at equal time steps as a table for the board's flash.

CSV: a line of names (`time` in seconds, then the machine's joints, in any order), then rows of
numbers in radians (or metres).
"""

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bridge.calibration import Calibration
from bridge.count_table import CountTable, count_table
from manipulator.errors import ConfigError, InvalidInput

TIME = 'time'
MOST_BYTES = 128 * 1024


def read_table(path: Path, calibration: Calibration) -> CountTable:
    """The table in a CSV file; ConfigError says what is wrong, and in which line."""
    try:
        with path.open(newline='', encoding='utf-8') as file:
            head, *lines = list(csv.reader(file))
        numbers = np.array([[float(cell) for cell in line] for line in lines])
    except (OSError, ValueError) as error:
        raise ConfigError([f'cannot be read as a table: {error}'], str(path)) from error
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


def flash_header(table: CountTable, name: str) -> str:
    """flash_table.h; ConfigError for a table that the chip cannot hold."""
    size = 2 * len(table.rows) * len(table.rows[0])
    if size > MOST_BYTES:
        raise ConfigError([f'takes {size} bytes of flash, at most {MOST_BYTES}'], name)
    rows = '\n'.join(f'    {_braces(row)}, \\' for row in table.rows)
    return (
        f'/* Made by `hexarm firmware-header --table` from {name}. */\n#pragma once\n\n'
        f'#define FLASH_TABLE_ROWS {len(table.rows)}\n'
        f'#define FLASH_TABLE_STEP_MS {table.step_ms}\n'
        f'#define FLASH_TABLE {{ \\\n{rows}\n}}\n'
    )


def _braces(row: Sequence[int]) -> str:
    return f'{{{", ".join(map(str, row))}}}'
