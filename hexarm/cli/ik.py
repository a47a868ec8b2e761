"""`hexarm ik MACHINE --xyz X Y Z --rpy R P Y`: the joints of a pose, or with --all every set."""

import argparse
from typing import Protocol, runtime_checkable

import numpy as np

from hexarm.cli.answers import (
    Answer,
    Units,
    add_machine,
    add_pose,
    answering,
    pose_asked,
    units_of,
)
from hexarm.cli.statuses import STATUSES
from hexarm.machines import load
from manipulator.arrays import Array
from manipulator.errors import InvalidInput
from manipulator.formatting import counted
from manipulator.machine import Machine
from manipulator.pose import Pose
from manipulator.unit_hints import hint_at_metres


@runtime_checkable
class Branched(Protocol):
    """A kinematics with more than one set of joints for a pose."""

    def inverse_all(self, pose: Pose) -> Array:
        """One set a row; rows of NaN are branches that do not close."""
        ...


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('ik', epilog=STATUSES)
    add_machine(parser)
    add_pose(parser)
    parser.add_argument('--all', action='store_true', help='every branch, also beyond limits')
    parser.add_argument(
        '--near', nargs='+', type=float, metavar='Q',
        help='one a joint, rad or m (or ° or mm): the branch and turns nearest to these',
    )  # fmt: skip
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Joint positions in radians or metres; a pose beyond any limit is refused."""
    machine = load(arguments.machine)
    pose = pose_asked(arguments)
    kinematics = machine.kinematics
    with hint_at_metres(kinematics, pose):
        joints = kinematics.inverse(pose, near_of(arguments, machine))
        if arguments.all:
            return every_branch(machine, pose, units_of(arguments))
        machine.constraints.check(pose, joints)
    names, positions, units = list(kinematics.joint_names), joints.tolist(), units_of(arguments)
    width = max(12, *map(len, names))
    lines = [
        f'{name:<{width}} {units.quantities([position], kinematics.joint_unit):>16}'
        for name, position in zip(names, positions, strict=True)
    ]
    return {'joints': {'names': names, 'positions': positions}}, lines


def near_of(arguments: argparse.Namespace, machine: Machine) -> Array | None:
    """The joints (n,) of --near; None without it, InvalidInput for another number of them."""
    if arguments.near is None:
        return None
    names, units = machine.kinematics.joint_names, units_of(arguments)
    if len(arguments.near) != len(names):
        count = counted(len(arguments.near), 'number')
        raise InvalidInput(f'--near: {count}, needs {len(names)}: {", ".join(names)}')
    is_angle = machine.kinematics.joint_unit == 'rad'
    near: Array = np.array(arguments.near) / (units.per_radian if is_angle else units.per_metre)
    if not np.isfinite(near).all():
        raise InvalidInput(f'--near: {near[~np.isfinite(near)][0]}, needs finite numbers')
    return near


def every_branch(machine: Machine, pose: Pose, units: Units) -> Answer:
    """All sets of joints for the pose, one a row, with the limits that each violates."""
    kinematics = machine.kinematics
    found = kinematics.inverse(pose)[None]
    if isinstance(kinematics, Branched):
        found = kinematics.inverse_all(pose)
    closed = found[np.isfinite(found).all(axis=1)]
    violations = [[str(v) for v in machine.constraints.violations(pose, q)] for q in closed]
    names, positions = list(kinematics.joint_names), closed.tolist()
    branches = [
        {'positions': q, 'violations': broken}
        for q, broken in zip(positions, violations, strict=True)
    ]
    unit = kinematics.joint_unit
    headers = [f'{name} ({units.name(unit)})' for name in names]
    numbers = [[units.number(value, unit) for value in q] for q in closed]
    width = max(14, *map(len, headers))
    lines = [
        '  '.join(f'{header:>{width}}' for header in headers),
        *(
            '  '.join(f'{number:>{width}}' for number in row)
            + (f'  {broken[0]}' if broken else '')
            for row, broken in zip(numbers, violations, strict=True)
        ),
    ]
    return {'names': names, 'branches': branches}, lines
