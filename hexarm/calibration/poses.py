"""`hexarm calibrate poses MACHINE`: which poses to measure, as a table to be filled in.

CSV files of commanded joints and measured poses: the columns and their units.

The names of the joints with their unit (`crank_1_deg`, `leg_1_mm`; also `_rad`, `_m`), then x, y,
z (`_mm` or `_m`) and an orientation: `qx,qy,qz,qw`, or `roll,pitch,yaw` (`_deg` or `_rad`).
Columns whose names begin with `goal_` are for people and not read.
"""

import argparse
import csv
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hexapod_control.identification.leg_model import Tolerances
from hexarm.calibration.machine_writer import machine_model, random_poses
from hexarm.machines import load
from manipulator import rotation as so3
from manipulator.analysis.device_frames import COUNT, DeviceFrames
from manipulator.analysis.measurements import Measurements, Model, Noise
from manipulator.analysis.observability import in_driving_order, most_telling, scales
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import counted, reason, shown
from manipulator.machine import Machine
from manipulator.pose import Pose

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
    """The column of a quantity, and its unit in SI."""
    found = [unit for unit in units if f'{name}_{unit}' in header]
    if len(found) != 1:
        alternatives = ' or '.join(f'{name}_{unit}' for unit in units)
        raise InvalidInput(f'needs one column {alternatives}; there are {", ".join(header)}')
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


CANDIDATES = 3000
MOST = 1000
KEPT_FROM_SINGULARITY = 0.25
"""Of the candidates, those nearest to a singularity: there an unmeasured machine may jump."""

TOLERANCES = Tolerances(5e-4, np.radians(1.0))
NOISE = Noise(1e-4, 1e-3)


def add_parser(parts: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the part."""
    parser = parts.add_parser('poses', help='which poses to measure, as a table to fill in')
    parser.add_argument('machine', metavar='MACHINE', help='a shipped name or the path of a file')
    parser.add_argument('--count', type=int, default=40, metavar='N', help='default 40')
    parser.add_argument('-o', '--output', metavar='FILE', help='default: standard output')
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Writes the table; InvalidInput where the file is there already."""
    if not 1 <= arguments.count <= MOST:
        raise InvalidInput(f'--count {arguments.count} outside [1, {MOST}]')
    if arguments.output and Path(arguments.output).exists():
        raise InvalidInput(f'{arguments.output} exists already: it is not overwritten')
    machine = load(arguments.machine)
    model = machine_model(machine.kinematics, TOLERANCES)
    joints, poses = telling_poses(machine, model, NOISE, arguments.count)
    kinematics = machine.kinematics
    text = planned(kinematics.joint_names, kinematics.joint_unit, joints, poses)
    if not arguments.output:
        print(text, end='')
        return 0
    try:
        Path(arguments.output).write_text(text)
    except OSError as error:
        raise InvalidInput(f'{arguments.output} cannot be written: {error.strerror}') from error
    print(f'{arguments.output}: {counted(len(joints), "pose")}; fill in the last seven columns')
    return 0


def telling_poses(machine: Machine, model: Model, noise: Noise, count: int) -> tuple[Array, Pose]:
    """Joints (count, m) and poses, in an order that is short to drive.

    The most telling of random poses of the whole workspace, away from singularities.
    """
    kinematics = machine.kinematics
    length = kinematics.characteristic_length
    joints, poses = random_poses(machine, max(CANDIDATES, 4 * count), np.random.default_rng(1))
    margins = kinematics.sigma_min(poses, joints)
    kept = margins >= np.quantile(margins, KEPT_FROM_SINGULARITY)
    joints, poses = joints[kept], poses[kept]
    own = model.slopes(np.zeros(len(model.parameters)), joints, poses)
    slopes = DeviceFrames.known().slopes(np.zeros(COUNT), poses, own)
    scale = scales((*model.parameters, *DeviceFrames.parameters()))
    weighted = slopes * noise.weights[:, None]
    chosen = np.array(most_telling(weighted, scale, count))
    offsets = kinematics.home.twist_to(poses[chosen]) * ([1.0] * 3 + [length] * 3)
    order = chosen[in_driving_order(offsets)]
    return joints[order], poses[order]
