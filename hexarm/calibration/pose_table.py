"""CSV files of commanded joints and measured poses: what stands in which column, in which unit.

The names of the joints with their unit (`crank_1_deg`, `leg_1_mm`; also `_rad`, `_m`), then x, y,
z (`_mm` or `_m`) and an orientation: `qx,qy,qz,qw`, or `roll,pitch,yaw` (`_deg` or `_rad`).
Columns whose names begin with `goal_` are for people and not read.
"""

import csv
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from manipulator import rotation as so3
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.identification.measurements import Measurements
from manipulator.pose import Pose
from manipulator.words import reason, shown

UNITS = {'mm': 1e-3, 'm': 1.0, 'deg': math.radians(1.0), 'rad': 1.0}
LENGTHS, ANGLES = ('mm', 'm'), ('deg', 'rad')
QUATERNION = ('qx', 'qy', 'qz', 'qw')
MOST_ROWS = 10_000


def measurements(path: str, names: Sequence[str], joint_unit: str) -> Measurements:
    """What a file holds, in SI; InvalidInput names line and column of what is wrong.

    Rows whose pose is empty were not measured and are left out.
    """
    header, rows = _read(Path(path).expanduser())
    of_joint = LENGTHS if joint_unit == 'm' else ANGLES
    joints = [_column(header, name, of_joint) for name in names]
    place = [_column(header, axis, LENGTHS) for axis in 'xyz']
    is_quaternion = set(QUATERNION) <= set(header)
    turn = (
        [(header.index(name), 1.0) for name in QUATERNION]
        if is_quaternion
        else [_column(header, name, ANGLES) for name in ('roll', 'pitch', 'yaw')]
    )
    pose_columns = [index for index, _ in (*place, *turn)]
    measured = [(line, row) for line, row in rows if any(row[i].strip() for i in pose_columns)]
    if not measured:
        raise InvalidInput(f'{path}: no row has a measured pose')
    q, p, r = (_numbers(path, header, measured, part) for part in (joints, place, turn))
    rotation = so3.from_quaternion(r) if is_quaternion else so3.from_rpy(r)
    return Measurements(q, Pose(p, rotation))


def planned(names: Sequence[str], joint_unit: str, joints: Array, poses: Pose) -> str:
    """A table to be filled in: joints, the poses that they should make, room for what is seen."""
    unit = 'mm' if joint_unit == 'm' else 'deg'
    goal = [f'goal_{name}' for name in (*('x_mm', 'y_mm', 'z_mm'), *QUATERNION)]
    header = [*(f'{name}_{unit}' for name in names), *goal, 'x_mm', 'y_mm', 'z_mm', *QUATERNION]
    lines = [','.join(header)]
    for q, place, turn in zip(joints, poses.position, poses.quaternion, strict=True):
        cells = [f'{angle / UNITS[unit]:.4f}' for angle in q]
        cells += [f'{1e3 * x:.4f}' for x in place] + [f'{x:.7f}' for x in turn] + [''] * 7
        lines.append(','.join(cells))
    return '\n'.join(lines) + '\n'


def _read(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    try:
        with path.open(newline='', encoding='utf-8-sig') as file:
            lines = [(i, row) for i, row in enumerate(csv.reader(file), start=1) if any(row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InvalidInput(f'{path} cannot be read: {reason(error)}') from error
    if len(lines) < 2:
        raise InvalidInput(f'{path}: needs a header and rows')
    if len(lines) > MOST_ROWS:
        raise InvalidInput(f'{path}: more than {MOST_ROWS} rows')
    header = [name.strip() for name in lines[0][1]]
    for line, row in lines[1:]:
        if len(row) != len(header):
            raise InvalidInput(
                f'{path}, line {line}: {len(row)} cells under {len(header)} columns'
            )
    return header, lines[1:]


def _column(header: Sequence[str], name: str, units: Sequence[str]) -> tuple[int, float]:
    """Where a quantity stands, and how much its unit is."""
    found = [unit for unit in units if f'{name}_{unit}' in header]
    if len(found) != 1:
        wanted = ' or '.join(f'{name}_{unit}' for unit in units)
        raise InvalidInput(f'needs one column {wanted}; there are {", ".join(header)}')
    return header.index(f'{name}_{found[0]}'), UNITS[found[0]]


def _numbers(
    path: str,
    header: Sequence[str],
    rows: Sequence[tuple[int, list[str]]],
    columns: Sequence[tuple[int, float]],
) -> Array:
    found = np.empty((len(rows), len(columns)))
    for k, (line, row) in enumerate(rows):
        for j, (index, unit) in enumerate(columns):
            try:
                found[k, j] = float(row[index]) * unit
            except ValueError:
                found[k, j] = math.nan
            if not math.isfinite(found[k, j]):
                raise InvalidInput(
                    f'{path}, line {line}: {header[index]} is {shown(row[index])}, no number'
                )
    return found
